#include "sysid/import/table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "document/problem.h"
#include "sysid/import/cell_value.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t widest_matrix = 200;

double finite_or_none(double value) {
  return std::isfinite(value) ? value : missing_value;
}

}  // namespace

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

void ArrayCollector::add(const std::string& name, const std::string& unit, std::size_t rows,
                         std::size_t columns, const std::vector<double>& values) {
  if (!has_room(rows, columns)) return skip(name, too_large);
  if (values.size() != rows * columns || values.size() < 2) return;
  values_ += values.size();
  const bool is_vector = rows == 1 || columns == 1;
  // If a matrix has more columns than rows, each row is taken as one signal.
  const bool lies = !is_vector && columns > rows;
  const std::size_t count = is_vector ? 1 : std::min(rows, columns);
  const std::size_t length = values.size() / count;
  if (count > widest_matrix) return skip(name, std::to_string(count) + " columns");
  for (std::size_t k = 0; k < count; ++k) {
    TableColumn column;
    const std::string number = std::to_string(k + 1);
    column.name = is_vector ? name : name + (lies ? "(" + number + ",:)" : "(:," + number + ")");
    column.unit = unit;
    column.values.reserve(length);
    for (std::size_t i = 0; i < length; ++i)
      column.values.push_back(finite_or_none(values[lies ? i * count + k : k * length + i]));
    columns_.push_back(std::move(column));
  }
}

void ArrayCollector::skip(const std::string& name, const std::string& what) {
  notes_.push_back("'" + document::shown(name) + "' is skipped: " + what);
}

std::optional<ForeignTable> ArrayCollector::table(const std::string& format,
                                                  document::Problems& problems) const {
  std::map<std::size_t, std::size_t> count_by_length;
  for (const TableColumn& column : columns_) ++count_by_length[column.values.size()];
  std::size_t length = 0;
  std::size_t most = 0;
  for (const auto& [candidate, count] : count_by_length) {
    const std::size_t values = count < 2 ? 0 : count * candidate;
    if (values < most) continue;
    most = values;
    length = candidate;
  }
  ForeignTable table;
  table.file = file_;
  table.format = format;
  table.notes = notes_;
  for (const TableColumn& column : columns_) {
    if (column.values.size() == length) {
      table.columns.push_back(column);
    } else {
      table.notes.push_back("'" + document::shown(column.name) +
                            "' is skipped: " + std::to_string(column.values.size()) +
                            " values, but other arrays have " + std::to_string(length));
    }
  }
  if (most > 0) return table;
  std::string said;
  for (const std::string& note : table.notes) said += (said.empty() ? "" : "; ") + note;
  problems.add(
      {file_, {1, 1}, {}, "the file does not contain two arrays of numbers with the same length", said});
  return std::nullopt;
}

std::string cells_with(const TableColumn& column, double value) {
  const auto count = std::count(column.values.begin(), column.values.end(), value);
  return std::to_string(count) + (count == 1 ? " cell" : " cells") + " of '" +
         document::shown(column.name, 40) + "'";
}

}  // namespace softgrip::sysid
