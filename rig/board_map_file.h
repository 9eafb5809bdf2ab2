#pragma once
// Reads board files (YAML) into a BoardMap. Unknown keys are errors. All problems of a file are reported
// together.
// Defines the suffixes of keys in rig files and board maps that give the unit of a value: V, mA or kPa.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "document/node.h"
#include "drivers/board/board_map.h"

namespace softgrip::rig {

/// Reads a board map from a parsed document. Adds all errors to `problems`, and returns nothing if there are
/// errors.
[[nodiscard]] std::optional<drivers::BoardMap> read_board_map(const document::Document& document,
                                                              document::Problems& problems);

/// Reads a board map from a file, with parse_file() and read_board_map().
[[nodiscard]] std::optional<drivers::BoardMap> load_board_map(const std::string& path,
                                                              document::Problems& problems);

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
