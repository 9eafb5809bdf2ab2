// The board of a rig file that is made of converters on this computer (industrial I/O).

#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;

constexpr std::int64_t largest_raw = (std::int64_t{1} << 24) - 1;

drivers::IioTerminal read_terminal(Context& context, const Node& node, bool output) {
  MapReader reader(context.document, node, context.problems, output ? "an output" : "an input");
  drivers::IioTerminal terminal;
  terminal.device = reader.text("device");
  terminal.channel = reader.text("channel");
  if (reader.good("channel") && !drivers::unit_of_channel(terminal.channel)) {
    reader.report(
        "channel",
        "`channel` must be a voltage or a current, found `" + document::shown(terminal.channel) + "`",
        "as in the names of the device's attributes: out_voltage0_raw is voltage0");
  }
  if (output) terminal.raw_max = reader.integer("raw_max", 1, largest_raw);
  return terminal;
}

}  // namespace

void read_iio(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "iio");
  drivers::IioSettings settings;
  settings.root = reader.optional_text("root").value_or(settings.root);
  for (const Node* input : reader.sequence("inputs", true)) {
    settings.inputs.push_back(read_terminal(context, *input, false));
  }
  for (const Node* output : reader.sequence("outputs", true)) {
    settings.outputs.push_back(read_terminal(context, *output, true));
  }
  read_timing(context, reader);
  context.modules.push_back({"iio", drivers::terminals_of(settings)});
  context.rig.board = std::move(settings);
}

}  // namespace softgrip::rig
