// Reads a board that consists of converters of this computer (industrial I/O) from a rig file.

#include <cmath>

#include "drivers/iio/iio_device.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;

/// Reads the terminals of the board. No two terminals may be the same channel of a converter.
class TerminalsReader {
 public:
  TerminalsReader(Context& context, const std::vector<ComputerDevice>& there)
      : context_(context), there_(there) {}

  std::vector<drivers::IioTerminal> inputs(MapReader& iio) {
    std::vector<drivers::IioTerminal> terminals;
    for (const Node* item : iio.sequence("inputs", true)) {
      MapReader reader(context_.document, *item, context_.problems, "an input");
      terminals.push_back(terminal(reader, false, known_inputs_));
    }
    return terminals;
  }

  std::vector<drivers::IioTerminal> outputs(MapReader& iio) {
    std::vector<drivers::IioTerminal> terminals;
    for (const Node* item : iio.sequence("outputs", true)) {
      MapReader reader(context_.document, *item, context_.problems, "an output");
      terminals.push_back(terminal(reader, true, known_outputs_));
      read_keys(reader, rig_keys().iio_output, terminals.back());
    }
    return terminals;
  }

  /// Reads the heartbeat output. This function is called after outputs(), because the heartbeat must not be
  /// one of the outputs.
  std::optional<drivers::IioHeartbeat> heartbeat(MapReader& iio) {
    const Node* const node = iio.child("heartbeat", false);
    if (node == nullptr) return std::nullopt;
    MapReader reader(context_.document, *node, context_.problems, "the heartbeat");
    drivers::IioHeartbeat heartbeat;
    heartbeat.terminal = terminal(reader, true, known_outputs_);
    read_keys(reader, rig_keys().heartbeat, heartbeat);
    const auto raws = reader.numbers("raw", 2, {0, largest_raw});
    if (reader.good("raw") &&
        (raws[0] == raws[1] || std::floor(raws[0]) != raws[0] || std::floor(raws[1]) != raws[1]))
      reader.report(
          "raw",
          "`raw` must be two different whole numbers, because the external circuit waits for a change");
    heartbeat.first = static_cast<long>(raws[0]);
    heartbeat.second = static_cast<long>(raws[1]);
    return heartbeat;
  }

 private:
  using Known = std::map<std::string, document::Location>;

  drivers::IioTerminal terminal(MapReader& reader, bool output, Known& known) {
    drivers::IioTerminal terminal;
    read_keys(reader, rig_keys().iio_terminal, terminal);
    check_channel(reader, terminal.channel, output);
    check_device(reader, terminal, known);
    return terminal;
  }

  static void check_channel(MapReader& reader, const std::string& channel, bool output) {
    if (!reader.good("channel")) return;
    const auto unit = drivers::unit_of_channel(channel);
    if (unit && !(output && unit == drivers::ElectricalUnit::kilopascal)) return;
    reader.report("channel",
                  std::string("`channel` must be a voltage") +
                      (output ? " or a current" : ", a current or a pressure") + ", found `" +
                      document::shown(channel) + "`",
                  std::string("as in the names of the device's attributes: ") + (output ? "out" : "in") +
                      "_voltage0_raw is voltage0");
  }

  /// Reports a word that matches several converters of this computer, and a converter channel that is listed
  /// twice. Accepts a word that matches no converter, because the rig may be connected to another computer.
  void check_device(MapReader& reader, const drivers::IioTerminal& terminal, Known& known) const {
    if (!reader.good("device") || !reader.good("channel")) return;
    const auto device = only_device(there_, terminal.device, "converter");
    if (!device && device.error().several) {
      reader.report("device", device.error().message, device.error().hint);
      return;
    }
    const auto [first, fresh] = known.try_emplace(
        (device ? device->node : terminal.device) + " " + terminal.channel, reader.where("device"));
    if (fresh) return;
    reader.report(
        "device",
        "`" + document::shown(terminal.channel) + "` of `" + document::shown(terminal.device) +
            "` is already listed at " + text_of(first->second),
        "if two converters have the same name, give the label, the serial number or the address of each");
  }

  Context& context_;
  const std::vector<ComputerDevice>& there_;
  Known known_inputs_;
  Known known_outputs_;
};

}  // namespace

void read_iio(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "iio");
  drivers::IioSettings settings;
  read_keys(reader, rig_keys().iio, settings);
  // If the rig is read from stored texts, this computer may not have the devices of the rig.
  const auto there =
      context.stored == nullptr ? drivers::converters_in(settings.root) : std::vector<ComputerDevice>{};
  TerminalsReader terminals(context, there);
  settings.inputs = terminals.inputs(reader);
  settings.outputs = terminals.outputs(reader);
  settings.heartbeat = terminals.heartbeat(reader);
  read_timing(context, reader);
  context.modules.push_back({"iio", drivers::terminals_of(settings)});
  context.rig.board = std::move(settings);
}

}  // namespace softgrip::rig
