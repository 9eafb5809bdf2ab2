#include "sysid/import/text_table.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "sysid/import/cell_value.h"
#include "sysid/import/text_dialect.h"
#include "sysid/import/text_encoding.h"
#include "sysid/import/units.h"
#include "sysid/logs/log_columns.h"
#include "sysid/logs/log_reporter.h"

namespace softgrip::sysid {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t bad_cells_kept = 3;

std::string name_of_separator(char separator) {
  if (separator == '\t') return "tabs";
  if (separator == ' ') return "blanks";
  return std::string("'") + separator + "'";
}

/// The rows of numbers, read into columns.
class RowReader {
 public:
  RowReader(const Dialect& dialect, const TableOptions& options, ForeignTable& table, LogReporter& report)
      : dialect_(dialect), options_(options), table_(table), report_(report), moments_(dialect.width) {
    table_.columns.resize(dialect.width);
    for (std::size_t i = 0; i < dialect.width; ++i) {
      if (!dialect.names.empty()) table_.columns[i].name = dialect.names[i];
      if (!dialect.units.empty()) table_.columns[i].unit = dialect.units[i];
      if (channel_ == dialect.width && lower_case(table_.columns[i].name) == channel_column) channel_ = i;
    }
  }

  void read(const TextLine& line, bool is_last) {
    const bool closed = split_line(line.text, dialect_.separator, cells_);
    if (cells_.size() != dialect_.width || !closed) {
      if (is_last && (cells_.size() < dialect_.width || !closed)) {
        table_.notes.emplace_back("the last line is cut off and left out");
      } else {
        report_.add("row", {line.number, 1}, line.text,
                    closed ? std::to_string(cells_.size()) + " cells where the rows above have " +
                                 std::to_string(dialect_.width)
                           : std::string("a quotation mark is not closed"));
      }
      return;
    }
    if (!belongs()) return;
    for (std::size_t i = 0; i < dialect_.width; ++i) read_cell(i, line);
    table_.line.push_back(line.number);
  }

  /// Decimal point and comma in one file: one of them must separate thousands.
  void check_decimals() {
    if (comma_.number == 0 || point_.number == 0) return;
    const TextLine& later = comma_.number > point_.number ? comma_ : point_;
    report_.add(
        "decimal", {later.number, 1}, later.text,
        "numbers with a decimal comma and numbers with a decimal point in one file",
        "the other kind first stands in line " + std::to_string(std::min(comma_.number, point_.number)));
  }
  [[nodiscard]] bool decimal_comma() const { return comma_.number != 0; }

 private:
  bool belongs() {
    if (channel_ == dialect_.width) return true;
    const std::string channel = cell_text(cells_[channel_].text);
    if (std::find(table_.channels.begin(), table_.channels.end(), channel) == table_.channels.end())
      table_.channels.push_back(channel);
    return options_.channel.empty() || channel == options_.channel;
  }

  void read_cell(std::size_t i, const TextLine& line) {
    TableColumn& column = table_.columns[i];
    const CellValue cell = cell_value(cells_[i].text, options_.missing);
    if (cell.with_comma && comma_.number == 0) comma_ = line;
    if (cell.with_point && point_.number == 0) point_ = line;
    switch (cell.kind) {
      case CellKind::number:
        column.values.push_back(cell.number);
        return;
      case CellKind::moment:
        column.values.push_back(moments_[i].seconds_after_first(cell, column.moments++ == 0));
        return;
      case CellKind::text:
        if (++column.bad_count <= bad_cells_kept)
          column.bad.push_back({column.values.size(),
                                {line.number, cells_[i].column},
                                std::string(line.text.substr(0, 200)),
                                std::string(trimmed(unquoted(cells_[i].text)))});
        break;
      case CellKind::missing:
        break;
    }
    column.values.push_back(nothing);
  }

  /// Whole nanoseconds are counted from a column's first moment: as seconds since 1970 they would lose
  /// digits. A time of day that falls back by half a day has passed midnight.
  struct Clock {
    Nanoseconds first = 0;
    Nanoseconds last = 0;
    Nanoseconds midnights = 0;

    double seconds_after_first(const CellValue& cell, bool is_first) {
      constexpr Nanoseconds day = 86400 * ns_per_s;
      if (is_first) first = last = cell.moment;
      if (!cell.dated && last - cell.moment > day / 2) midnights += day;
      last = cell.moment;
      return seconds(cell.moment - first + midnights);
    }
  };

  const Dialect& dialect_;
  const TableOptions& options_;
  ForeignTable& table_;
  LogReporter& report_;
  std::vector<Clock> moments_;
  std::vector<Cell> cells_;
  std::size_t channel_ = dialect_.width;
  TextLine comma_;
  TextLine point_;
};

}  // namespace

std::optional<ForeignTable> parse_text_table(const std::string& file, std::string_view bytes,
                                             const TableOptions& options, document::Problems& problems) {
  const auto refused_with = [&](const std::string& what) {
    problems.add({file, {1, 1}, {}, "the text has more than " + what, "split it into several files"});
    return std::nullopt;
  };
  if (bytes.size() > most_text_bytes) return refused_with(std::to_string(most_text_bytes) + " bytes");
  const auto text = utf8_of(bytes);
  if (!text) {
    problems.add({file, {1, 1}, {}, text.error(), "export it as CSV"});
    return std::nullopt;
  }
  if (static_cast<std::size_t>(std::count(text->begin(), text->end(), '\n')) > most_rows)
    return refused_with(std::to_string(most_rows) + " lines");
  const TextLines lines = text_lines(*text);
  const auto dialect = dialect_of(file, lines, options, problems);
  if (!dialect) return std::nullopt;
  if (lines.content.size() > most_values / std::max<std::size_t>(dialect->width, 1))
    return refused_with(std::to_string(most_values) + " values");
  ForeignTable table;
  table.file = file;
  LogReporter report(file, problems);
  RowReader rows(*dialect, options, table, report);
  for (std::size_t i = dialect->first_row; i < lines.content.size(); ++i)
    rows.read(lines.content[i], i + 1 == lines.content.size());
  rows.check_decimals();
  report.finish();
  if (report.any()) return std::nullopt;
  table.format = "text, " + name_of_separator(dialect->separator) + " between columns" +
                 (rows.decimal_comma() ? ", decimal comma" : "") +
                 (dialect->units.empty() ? "" : ", a row of units");
  if (const auto above =
          dialect->first_row - (dialect->names_line > 0 ? 1 : 0) - (dialect->units.empty() ? 0 : 1);
      above > 0 && above < lines.content.size())
    table.notes.push_back(std::to_string(above) + (above == 1 ? " line" : " lines") +
                          " above the columns' names passed over");
  return table;
}

}  // namespace softgrip::sysid
