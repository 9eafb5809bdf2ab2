#include "sysid/logs/log_header.h"

#include <algorithm>
#include <optional>

#include "base/numbers.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {
namespace {

/// Reports a column whose name is that of a column of the log format, but without a unit or with another
/// unit. Suggests the name of the log format.
void report_near_miss(const Cell& cell, std::string_view name, std::string_view line, LogReporter& report) {
  for (const KnownColumn& known : known_columns) {
    const std::string_view unit = known.name.substr(known.quantity.size() + 1);
    const bool bare = name == known.quantity;
    const bool other_unit = name.size() > known.quantity.size() + 1 && name.starts_with(known.quantity) &&
                            name[known.quantity.size()] == '_' &&
                            !conversion(name.substr(known.quantity.size() + 1)).empty();
    if (!bare && !other_unit) continue;
    const std::string expected = "expected '" + std::string(known.name) + "'";
    if (bare) {
      report.add("unit", {1, cell.column}, line, "column '" + std::string(name) + "' has no unit",
                 expected + ", in " + std::string(unit));
    } else {
      report.add("unit", {1, cell.column}, line, "column '" + std::string(name) + "' has the wrong unit",
                 expected + conversion(name.substr(known.quantity.size() + 1)));
    }
    return;
  }
}

/// Checks the header line for formal errors, before its column names are interpreted.
bool header_is_plausible(std::string_view line, const std::vector<Cell>& cells, LogReporter& report) {
  if (cells.size() == 1 && line.find(';') != std::string_view::npos) {
    report.add("separator", {1, static_cast<int>(line.find(';')) + 1}, line,
               "the columns are separated by ';'", "a log requires ',' between columns and '.' in numbers");
    return false;
  }
  if (cells.size() == 1 && line.find('\t') != std::string_view::npos) {
    report.add("separator", {1, static_cast<int>(line.find('\t')) + 1}, line,
               "the columns are separated by tabs", "a log requires ',' between columns");
    return false;
  }
  if (std::all_of(cells.begin(), cells.end(), [](const Cell& c) { return to_number(c.text).has_value(); })) {
    report.add("header", {1, 1}, line, "the first line contains numbers instead of column names",
               "write 'time_s,pressure_command_kpa,displacement_mm' above the first line");
    return false;
  }
  return true;
}

/// Returns the first element of `reading_columns` whose name occurs in the header.
std::optional<ReadingColumn> reading_column(const std::vector<Cell>& cells) {
  for (const ReadingColumn& column : reading_columns) {
    if (std::any_of(cells.begin(), cells.end(),
                    [&](const Cell& cell) { return cell_text(cell.text) == column.name; }))
      return column;
  }
  return std::nullopt;
}

/// Returns the hint for a log that lacks the column `column`. The hint suggests a column of the log with a
/// similar name.
std::string hint_of_missing(std::string_view column, const std::vector<std::string>& names) {
  const auto angle = std::find_if(names.begin(), names.end(),
                                  [](const std::string& name) { return name.starts_with("angle"); });
  if (column == reading_columns.front().name && angle != names.end())
    return "is it '" + *angle + "'? For a bending angle, use 'angle_deg' or 'angle_rad'";
  const std::string near = document::nearest(column, names);
  return near.empty() ? std::string() : "is it '" + near + "'?";
}

}  // namespace

LogHeader read_header(std::string_view line, const LogOptions& options, LogReporter& report) {
  LogHeader header;
  header.index.fill(-1);
  header.column.fill(1);
  std::vector<Cell> cells;
  if (!split(line, cells)) {
    report.add("header", {1, 1}, line, "a quotation mark is not closed", {});
    return header;
  }
  if (!header_is_plausible(line, cells, report)) return header;
  if (const auto reading = reading_column(cells)) header.reading = *reading;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name = cell_text(cells[i].text);
    const auto known = std::find_if(known_columns.begin(), known_columns.end(), [&](const KnownColumn& k) {
      return (k.values == &Log::displacement_mm ? header.reading.name : k.name) == name;
    });
    const bool repeated =
        !name.empty() && std::find(header.names.begin(), header.names.end(), name) != header.names.end();
    if (repeated) {
      report.add("duplicate", {1, cells[i].column}, line, "column '" + name + "' occurs twice", {});
    } else if (known != known_columns.end()) {
      const auto k = static_cast<std::size_t>(known - known_columns.begin());
      header.index[k] = static_cast<int>(i);
      header.column[k] = cells[i].column;
    } else if (name == channel_column) {
      header.channel = static_cast<int>(i);
    } else {
      report_near_miss(cells[i], name, line, report);
    }
    header.names.push_back(name);
  }
  if (const int k = header.index[column_displacement];
      k >= 0 && options.output_unit && *options.output_unit != header.reading.unit) {
    report.add("unit", {1, header.column[column_displacement]}, line,
               "column '" + std::string(header.reading.name) + "' gives readings in " +
                   std::string(name_of(header.reading.unit)) + ", and " + options.output_unit_of + " is in " +
                   std::string(name_of(*options.output_unit)),
               "a model and its logs must have the same unit");
  }
  for (std::size_t k = 0; k < known_columns.size(); ++k) {
    if (!known_columns[k].required || header.index[k] >= 0) continue;
    if (k == column_displacement && !options.need_readings) continue;
    report.add("missing", {1, 1}, line, "column '" + std::string(known_columns[k].name) + "' is missing",
               hint_of_missing(known_columns[k].name, header.names));
  }
  return header;
}

}  // namespace softgrip::sysid
