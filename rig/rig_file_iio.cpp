// The board of a rig file that is made of converters on this computer (industrial I/O).

#include "drivers/iio/iio_device.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;

constexpr std::int64_t largest_raw = (std::int64_t{1} << 24) - 1;

/// Reads the terminals of one direction, each of which must be another channel of another converter.
class TerminalsReader {
 public:
  TerminalsReader(Context& context, const std::vector<ComputerDevice>& there)
      : context_(context), there_(there) {}

  std::vector<drivers::IioTerminal> read(MapReader& iio, std::string_view key, bool output) {
    std::map<std::string, document::Location> known;
    std::vector<drivers::IioTerminal> terminals;
    for (const Node* item : iio.sequence(key, true)) {
      MapReader reader(context_.document, *item, context_.problems, output ? "an output" : "an input");
      drivers::IioTerminal terminal;
      terminal.device = reader.text("device");
      terminal.channel = reader.text("channel");
      check_channel(reader, terminal.channel);
      check_device(reader, terminal, known);
      if (output) terminal.raw_max = reader.integer("raw_max", 1, largest_raw);
      terminals.push_back(std::move(terminal));
    }
    return terminals;
  }

 private:
  static void check_channel(MapReader& reader, const std::string& channel) {
    if (!reader.good("channel") || drivers::unit_of_channel(channel)) return;
    reader.report("channel",
                  "`channel` must be a voltage or a current, found `" + document::shown(channel) + "`",
                  "as in the names of the device's attributes: out_voltage0_raw is voltage0");
  }

  /// A word that fits two converters of this computer would let their order decide. One that fits none may be
  /// right on the computer of the rig.
  void check_device(MapReader& reader, const drivers::IioTerminal& terminal,
                    std::map<std::string, document::Location>& known) const {
    if (!reader.good("device") || !reader.good("channel")) return;
    const auto device = only_device(there_, terminal.device, "converter");
    if (!device && device.error().several) {
      reader.report("device", device.error().message, device.error().hint);
      return;
    }
    const auto [first, fresh] = known.try_emplace(
        (device ? device->node : terminal.device) + " " + terminal.channel, reader.where("device"));
    if (fresh) return;
    reader.report("device",
                  "`" + document::shown(terminal.channel) + "` of `" + document::shown(terminal.device) +
                      "` is already listed at " + place(first->second),
                  "two converters of one name are told apart by label, serial number or address");
  }

  Context& context_;
  const std::vector<ComputerDevice>& there_;
};

}  // namespace

void read_iio(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "iio");
  drivers::IioSettings settings;
  settings.root = reader.optional_text("root").value_or(settings.root);
  // A stored rig is read where it may not be driven.
  const auto there =
      context.stored == nullptr ? drivers::converters_in(settings.root) : std::vector<ComputerDevice>{};
  TerminalsReader terminals(context, there);
  settings.inputs = terminals.read(reader, "inputs", false);
  settings.outputs = terminals.read(reader, "outputs", true);
  read_timing(context, reader);
  context.modules.push_back({"iio", drivers::terminals_of(settings)});
  context.rig.board = std::move(settings);
}

}  // namespace softgrip::rig
