#include "sysid/import/table.h"

#include <algorithm>

#include "sysid/import/cell_value.h"

namespace softgrip::sysid {

std::size_t column_index(const ForeignTable& table, std::string_view word) {
  const auto named = [&](const TableColumn& column) { return column.name == word && !word.empty(); };
  const auto count = std::count_if(table.columns.begin(), table.columns.end(), named);
  if (count == 1) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(), named);
    return static_cast<std::size_t>(found - table.columns.begin());
  }
  const std::size_t number = count == 0 ? whole_number(word).value_or(0) : 0;
  return number < 1 || number > table.columns.size() ? table.columns.size() : number - 1;
}

std::string word_of(const ForeignTable& table, std::size_t index) {
  const std::string& name = table.columns[index].name;
  return column_index(table, name) == index ? name : std::to_string(index + 1);
}

}  // namespace softgrip::sysid
