#pragma once
// Interpretation of one cell of an imported text file: number, missing value, time or other text.

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
  double number = 0;            ///< value of a number; finite
  Nanoseconds moment = 0;       ///< value of a timestamp
  bool dated = false;           ///< the timestamp has a date
  bool short_clock = false;     ///< the timestamp has two fields
  bool surely_minutes = false;  ///< the two fields are minutes and seconds
  int missing_word = -1;        ///< index of the word in `missing` that the cell contains; -1: none
  bool with_comma = false;      ///< the number has a decimal comma
  bool with_point = false;      ///< the number has a decimal point
};

/// Interprets a cell. A comma before digits is a decimal comma. A cell with a comma and a point is not a
/// number: 1.234,5. Missing values are an empty cell, NaN, NA, null, inf and similar words, and the words in
/// `missing` (in lower case; numbers are compared by value).
[[nodiscard]] CellValue cell_value(std::string_view cell, const std::vector<std::string>& missing);

/// Returns the value of a text that consists of decimal digits only; nullopt for another text.
[[nodiscard]] std::optional<std::size_t> whole_number(std::string_view text);

}  // namespace softgrip::sysid
