#pragma once
// Determines if the commas in a column of numbers can separate thousands instead of being decimal commas.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sysid/import/cell_value.h"

namespace softgrip::sysid {

/// Commas in the cells of a column.
class DecimalCommas {
 public:
  /// Adds the next cell of the column.
  void add(const CellValue& cell, std::string_view text);

  /// Returns the first cell such as "20,000", whose comma can be a decimal comma or separate thousands.
  /// Returns "" if the commas have a clear meaning: a comma cannot separate thousands ("20,5"), or all
  /// numbers have one comma. Numbers without a comma are ignored if all of them are the same code for a
  /// missing value, such as 999 (sensor_codes.h).
  /// @param values  values of the column.
  [[nodiscard]] std::string ambiguous_cell(std::span<const double> values) const;

 private:
  std::string grouped_;      ///< first cell in which each comma can separate thousands
  bool is_decimal_ = false;  ///< true: a comma cannot separate thousands
  bool differs_ = false;     ///< true: a cell has several commas, or `without_comma_` is not unique
  std::optional<double> without_comma_;  ///< first number without a comma
};

}  // namespace softgrip::sysid
