#include "drivers/gpio/gpio_lines.h"

namespace softgrip::drivers {

std::string text_of(const GpioLineSettings& line) {
  std::string text = line.chip + " line ";
  text += line.line.empty() ? std::to_string(line.offset.value_or(0)) : "`" + line.line + "`";
  return text + (line.active_low ? ", active low" : ", active high");
}

}  // namespace softgrip::drivers
