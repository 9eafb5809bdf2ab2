#pragma once
// Numbers that mean a missing value, such as 999.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Returns the number that a word for a missing value represents, such as 999; nullopt if the word is not a
/// number.
[[nodiscard]] std::optional<double> missing_number(const std::string& word);

/// Returns the numbers that mean a missing value in a column of the table. A column of dates or times of day
/// has no such numbers.
[[nodiscard]] std::vector<double> missing_codes(const ForeignTable& table, const Mapping& mapping,
                                                std::size_t column);

/// Returns the codes for missing values that a column with this role seems to contain (sensor_codes.h). In a
/// column of commands, only typical codes such as 999 count as codes.
[[nodiscard]] std::vector<double> codes_for(const TableColumn& column, Role role);

/// Returns the values of a column; each code for a missing value is replaced by NaN.
[[nodiscard]] std::vector<double> without_codes(const ForeignTable& table, const Mapping& mapping,
                                                std::size_t column);

}  // namespace softgrip::sysid
