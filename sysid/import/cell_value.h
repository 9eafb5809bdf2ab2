#pragma once
// Interprets one cell of an imported text file as a number, a missing value, a time or another text.

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
  double number = 0;            ///< value of a cell that contains a number; always finite
  Nanoseconds moment = 0;       ///< value of a cell that contains a timestamp
  bool dated = false;           ///< true: the timestamp has a date
  bool short_clock = false;     ///< true: the timestamp has only two fields, such as "12:34"
  bool surely_minutes = false;  ///< true: the timestamp has two fields that cannot be hours and minutes
  /// Index of the word in the list `missing` that equals the cell; -1: no word equals the cell.
  int missing_word = -1;
  bool with_comma = false;  ///< true: the number has a decimal comma
  bool with_point = false;  ///< true: the number has a decimal point
  /// True: each comma of the cell can separate thousands, as in "20,000" and "1,234,567".
  bool grouped = false;
};

/// Interprets a cell. A comma followed by digits is a decimal comma. A cell with a comma and a point
/// ("1.234,5") is not a number. A cell is a missing value if it is empty or contains NaN, NA, null, inf or a
/// similar word. A cell that equals a word in the list `missing` is a missing value too. The words in this
/// list are in lower case, and numbers are compared by value.
[[nodiscard]] CellValue cell_value(std::string_view cell, const std::vector<std::string>& missing);

/// Returns the value of a text that consists of decimal digits only; nullopt for any other text, and for a
/// value that is too large.
[[nodiscard]] std::optional<std::size_t> whole_number(std::string_view text);

}  // namespace softgrip::sysid
