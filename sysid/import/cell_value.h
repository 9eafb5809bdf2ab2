#pragma once
// Interprets one cell of an imported text file as a number, a missing value, a time or another text.
// Determines if the commas or points in a column of cells can separate thousands instead of being decimal
// marks.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
  /// True: each comma or point of the cell can separate thousands, as in "20,000" and "1.234.567".
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

/// Decimal marks in the cells of a column.
class DecimalMarks {
 public:
  /// Adds the next cell of the column.
  void add(const CellValue& cell, std::string_view text);

  /// Returns the first cell such as "20,000" or "1.234", whose mark can be a decimal mark or separate
  /// thousands. Returns "" if the marks have a clear meaning: a mark cannot separate thousands ("20,5"), or
  /// all numbers have one mark. Numbers without a comma are ignored if all of them are the same code for a
  /// missing value, such as 999 (sensor_codes.h). Numbers without a point are ignored if all of them are
  /// equal.
  /// @param values  values of the column.
  [[nodiscard]] std::string ambiguous_cell(std::span<const double> values) const;

 private:
  std::string grouped_;                 ///< first cell in which each mark can separate thousands
  bool is_decimal_ = false;             ///< true: a mark cannot separate thousands
  bool differs_ = false;                ///< true: a cell has several marks, or `without_mark_` is not unique
  std::optional<double> without_mark_;  ///< first number without a decimal mark
};

}  // namespace softgrip::sysid
