#include "sysid/pages/axis_words.h"

#include <array>
#include <utility>

namespace softgrip::sysid {

std::string in_words(std::string_view label) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 18> units{{
      {"s", "seconds"},
      {"mm", "millimetres"},
      {"kPa", "kilopascals"},
      {"kPa/s", "kilopascals per second"},
      {"mm/s", "millimetres per second"},
      {"mm/kPa", "millimetres per kilopascal"},
      {"deg", "degrees"},
      {"deg/s", "degrees per second"},
      {"deg/kPa", "degrees per kilopascal"},
      {"deg\xc2\xb2", "square degrees"},
      {"deg\xc2\xb2/Hz", "square degrees per hertz"},
      {"Hz", "hertz"},
      {"mm\xc2\xb2", "square millimetres"},
      {"mm\xc2\xb2/Hz", "square millimetres per hertz"},
      {"\xc2\xb0"
       "C",
       "degrees Celsius"},
      {"C", "degrees Celsius"},
      {"min", "minutes"},
      {"%", "per cent"},
  }};
  const std::size_t open = label.rfind('[');
  const bool alone = open == 0;
  if (open == std::string_view::npos || !label.ends_with(']') || (!alone && label[open - 1] != ' '))
    return std::string(label);
  const std::string_view unit = label.substr(open + 1, label.size() - open - 2);
  for (const auto& [sign, words] : units) {
    if (unit == sign)
      return alone ? std::string(words)
                   : std::string(label.substr(0, open - 1)) + " in " + std::string(words);
  }
  return std::string(label);
}

}  // namespace softgrip::sysid
