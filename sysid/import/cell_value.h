#pragma once
// What a cell of a foreign text says.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.h"

namespace softgrip::sysid {

enum class CellKind : std::uint8_t { number, missing, moment, text };

struct CellValue {
  CellKind kind = CellKind::text;
  double number = 0;            ///< of a number; finite
  Nanoseconds moment = 0;       ///< of a moment
  bool dated = false;           ///< the moment has a date
  bool short_clock = false;     ///< the moment has two fields
  bool surely_minutes = false;  ///< they are minutes and seconds
  int missing_word = -1;        ///< index of the word in `missing` that the cell says
  bool with_comma = false;      ///< the number has a decimal comma
  bool with_point = false;      ///< the number has a decimal point
};

/// A comma before digits is a decimal one where no point stands beside it: 1.234,5 is no number. Missing are
/// an empty cell, NaN, NA, null, inf and the like, and the words in `missing` (lower-case; numbers by their
/// value).
[[nodiscard]] CellValue cell_value(std::string_view cell, const std::vector<std::string>& missing);

/// The number of a text that has only decimal digits.
[[nodiscard]] std::optional<std::size_t> whole_number(std::string_view text);

}  // namespace softgrip::sysid
