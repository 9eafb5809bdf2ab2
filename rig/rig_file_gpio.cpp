// Reads the digital lines of a rig file.

#include "drivers/gpio/gpio_lines.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;
using drivers::GpioBias;
using drivers::GpioLineSettings;
using drivers::GpioRole;

/// Length of the longest line name in the kernel [bytes].
constexpr std::size_t longest_name = 31;

/// Checks the name of a line, and the word that identifies a chip. Reports an error if the word matches
/// several chips of this computer. Accepts a word that matches no chip, because the rig may be connected to
/// another computer.
void check_which_line(MapReader& reader, const GpioLineSettings& line,
                      const std::vector<ComputerDevice>& there, const std::string& what) {
  const auto found = only_device(there, line.chip, "GPIO chip");
  if (!found && found.error().several) reader.report("chip", found.error().message, found.error().hint);
  if (line.line.size() > longest_name)
    reader.report("line", "`line` is longer than 31 bytes, the longest name of a GPIO line in the kernel");
  if (reader.has("line") == reader.has("offset") && !reader.keys().empty()) {
    reader.report(reader.has("line") ? "offset" : "chip",
                  what + " needs either `line` (its name) or `offset` (its number in the chip)",
                  "`gpioinfo` lists both");
  }
}

/// Warns if a broken wire would look like a released emergency stop, or like a part in position. If a wire
/// breaks, the pull resistor of the chip determines the level of the input.
void check_broken_wire(MapReader& reader, const GpioLineSettings& line) {
  if (line.bias != GpioBias::pull_up && line.bias != GpioBias::pull_down) return;
  const bool open_is_active = (line.bias == GpioBias::pull_up) != line.active_low;
  const bool trips_when_active = line.role == GpioRole::emergency_stop;
  if (open_is_active == trips_when_active) return;
  reader.warn("bias",
              trips_when_active ? "a broken wire would read as a released emergency stop"
                                : "a broken wire would read as a part in position",
              "keep `active`, select the other pull resistor in `bias`, and use a contact that is closed in "
              "normal operation");
}

/// Reads the line for a purpose, if the file contains such a line. `there` contains the chips of this
/// computer.
void read_line(Context& context, MapReader& gpio, const std::vector<ComputerDevice>& there, GpioRole role) {
  const std::string name(drivers::name_of(role));
  const Node* const node = gpio.child(name, false);
  if (node == nullptr) return;
  GpioSettings& settings = *context.rig.gpio;
  MapReader reader(context.document, *node, context.problems, name);
  GpioLineSettings line;
  line.role = role;
  read_keys(reader, rig_keys().gpio_line, line);
  check_which_line(reader, line, there, name);
  if (drivers::is_input(role)) {
    read_keys(reader, rig_keys().gpio_input, line);
    if (reader.good("bias")) check_broken_wire(reader, line);
  }
  if (role == GpioRole::enable) read_keys(reader, rig_keys().gpio_enable, settings);
  for (std::size_t i = 0; i < settings.lines.size(); ++i) {
    const GpioLineSettings& other = settings.lines[i];
    if (other.chip != line.chip || other.line != line.line || other.offset != line.offset) continue;
    reader.report(line.line.empty() ? "offset" : "line", "this line is already the `" +
                                                             std::string(drivers::name_of(other.role)) +
                                                             "` at " + text_of(settings.places[i].at));
  }
  settings.places.push_back(context.document.problem(node->at, ""));
  settings.lines.push_back(std::move(line));
}

}  // namespace

void read_gpio(Context& context, MapReader& top) {
  const Node* const node = top.child("gpio", false);
  if (node == nullptr) return;
  GpioSettings& settings = context.rig.gpio.emplace();
  MapReader reader(context.document, *node, context.problems, "gpio");
  read_keys(reader, rig_keys().gpio, settings);
  // If the rig is read from stored texts, this computer may not have the devices of the rig.
  const auto there = context.stored == nullptr ? drivers::chips_in() : std::vector<ComputerDevice>{};
  for (const auto& [role, name] : drivers::gpio_role_names) read_line(context, reader, there, role);
  reader.finish();
  if (settings.lines.empty() && node->kind == Node::Kind::map) {
    top.report("gpio", "`gpio` names no line",
               "name at least one of emergency_stop, part_in_position, enable, ready_lamp, fault_lamp");
  }
  if (settings.stale_after_s < 4 * settings.look_interval_s && reader.good("stale_after_s")) {
    reader.report("stale_after_s", "`stale_after_s` must be at least four times `look_interval_s`");
  }
}

}  // namespace softgrip::rig
