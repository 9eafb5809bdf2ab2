#include "sysid/import/missing_codes.h"

#include <algorithm>

#include "base/numbers.h"
#include "sysid/logs/sensor_codes.h"

namespace softgrip::sysid {

std::optional<double> missing_number(const std::string& word) {
  return to_number(word);
}

std::vector<double> missing_codes(const ForeignTable& table, const Mapping& mapping, std::size_t column) {
  std::vector<double> codes;
  if (table.columns[column].moments > 0) return codes;
  for (const std::string& word : mapping.missing) {
    if (const auto number = missing_number(word)) codes.push_back(*number);
  }
  for (const ColumnCode& code : mapping.missing_in) {
    if (column_index(table, code.column) == column) codes.push_back(code.value);
  }
  return codes;
}

std::vector<double> codes_for(const TableColumn& column, Role role) {
  // A few high pressures among low pressures are correct commands.
  return sensor_codes(column.values, role == Role::command ? CodeKinds::typical : CodeKinds::any);
}

std::vector<double> without_codes(const ForeignTable& table, const Mapping& mapping, std::size_t column) {
  std::vector<double> values = table.columns[column].values;
  for (const double code : missing_codes(table, mapping, column))
    std::replace(values.begin(), values.end(), code, missing_value);
  return values;
}

}  // namespace softgrip::sysid
