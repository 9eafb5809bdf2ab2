#include "drivers/gpio/gpio_lines.h"

namespace softgrip::drivers {

std::string_view name_of(GpioRole role) noexcept {
  switch (role) {
    case GpioRole::emergency_stop:
      return "emergency_stop";
    case GpioRole::part_in_position:
      return "part_in_position";
    case GpioRole::enable:
      return "enable";
    case GpioRole::ready_lamp:
      return "ready_lamp";
    case GpioRole::fault_lamp:
      return "fault_lamp";
  }
  return "?";
}

std::string text_of(const GpioLineSettings& line) {
  std::string text = line.chip + " line ";
  text += line.line.empty() ? std::to_string(line.offset.value_or(0)) : "`" + line.line + "`";
  return text + (line.active_low ? ", active low" : ", active high");
}

}  // namespace softgrip::drivers
