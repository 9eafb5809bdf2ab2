#pragma once
// The suffixes of keys in rig files and board maps that give the unit of a value: V, mA or kPa.

#include <array>
#include <string_view>
#include <utility>

#include "drivers/board/board_map.h"

namespace softgrip::rig {

inline constexpr std::array<std::pair<std::string_view, drivers::ElectricalUnit>, 3> electrical_suffixes{
    {{"_v", drivers::ElectricalUnit::volt},
     {"_ma", drivers::ElectricalUnit::milliampere},
     {"_kpa", drivers::ElectricalUnit::kilopascal}}};

[[nodiscard]] constexpr std::string_view suffix_of(drivers::ElectricalUnit unit) noexcept {
  for (const auto& [suffix, of] : electrical_suffixes) {
    if (of == unit) return suffix;
  }
  return {};
}

}  // namespace softgrip::rig
