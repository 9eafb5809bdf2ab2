#include "sysid/import/table_readers.h"

#include <algorithm>
#include <vector>

#include "sysid/import/cell_value.h"
#include "sysid/import/clock.h"
#include "sysid/import/fingers.h"
#include "sysid/import/moments.h"
#include "sysid/import/text_clock.h"
#include "sysid/import/text_dialect.h"
#include "sysid/import/units.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t bad_cells_kept = 3;
constexpr std::size_t bad_lines_named = 10;

std::string name_of_separator(char separator) {
  if (separator == '\t') return "tabs";
  if (separator == ' ') return "blanks";
  return std::string("'") + separator + "'";
}

/// Returns the number of empty lines above every row except the first. Some programs end each row with two
/// line breaks.
int empty_above_each_row(const TextLines& lines, std::size_t first_row) {
  int fewest = first_row + 1 < lines.content.size() ? lines.content[first_row + 1].empty_above : 0;
  for (std::size_t i = first_row + 1; i < lines.content.size(); ++i)
    fewest = std::min(fewest, lines.content[i].empty_above);
  return fewest;
}

/// Reads the rows of numbers into columns.
class RowReader {
 public:
  /// @param text  the whole text, of which the rows are parts.
  RowReader(std::string_view text, const TextLines& lines, const Dialect& dialect,
            const TableOptions& options, ForeignTable& table, LogReporter& report)
      : text_(text),
        lines_(lines),
        dialect_(dialect),
        options_(options),
        table_(table),
        report_(report),
        clocks_(dialect.width) {
    table_.missing_cells.resize(options.missing.size());
    table_.columns.resize(dialect.width);
    for (std::size_t i = 0; i < dialect.width; ++i) {
      if (!dialect.names.empty()) table_.columns[i].name = dialect.names[i];
      if (!dialect.units.empty()) table_.columns[i].unit = dialect.units[i];
      const bool as_in_a_log = lower_case(table_.columns[i].name) == channel_column;
      const bool is_first = channel_ == dialect.width && names_channel(table_.columns[i].name);
      if (DateColumn::has_name(table_.columns[i].name)) date_column_ = i;
      if (is_first || (as_in_a_log && !is_log_channel_)) channel_ = i;
      is_log_channel_ = is_log_channel_ || as_in_a_log;
    }
    if (channel_ < dialect.width) table_.channel_column = table_.columns[channel_].name;
  }

  void read(const TextLine& line, bool is_last) {
    count_omitted(line);
    ++table_.account.rows;
    const bool closed = split_line(line.text, dialect_.separator, cells_);
    drop_extra_cell();
    if (closed && !is_last && begins_other_table(cells_, dialect_, options_)) return refuse_table(line);
    if (cells_.size() != dialect_.width || !closed) return leave_out(line, is_last, closed);
    cut_off_.add(line.text, cells_.back().text);
    if (is_last && cut_off_.may_be_cut_off(text_))
      table_.warnings.push_back("line " + std::to_string(line.number) + ": " +
                                cut_off_sentence(cells_.back().text));
    if (!belongs()) return table_.account.leave_out(LeftOut::other_channel);
    if (table_.line.empty()) find_time_of_day();
    if (date_column_ < dialect_.width) {
      read_date();
      days_s_.push_back(seconds(date_.since_first()));
    }
    for (std::size_t i = 0; i < dialect_.width; ++i) read_cell(i, line);
    table_.line.push_back(line.number);
    table_.position.push_back(position_++);
  }

  void finish() {
    for (std::size_t i = 0; i < dialect_.width; ++i)
      table_.columns[i].ambiguous_mark = marks_[i].ambiguous_cell(table_.columns[i].values);
    continue_clocks();
    if (skipped_.empty()) return;
    std::string lines;
    for (std::size_t i = 0; i < skipped_.size() && i < bad_lines_named; ++i)
      lines += (lines.empty() ? "" : ", ") + std::to_string(skipped_[i]);
    const bool is_one = skipped_.size() == 1;
    table_.notes.push_back("--skip-bad-lines leaves out " + std::to_string(skipped_.size()) +
                           (is_one ? " line" : " lines") + " with too few or too many cells, in " +
                           (is_one ? "line " : "lines ") + lines +
                           (skipped_.size() > bad_lines_named ? ", ..." : ""));
  }

  /// Refuses a file that contains both decimal points and decimal commas. In such a file, one of the two
  /// marks may separate thousands.
  void check_decimals() {
    if (comma_.number == 0 || point_.number == 0) return;
    const TextLine& later = comma_.number > point_.number ? comma_ : point_;
    report_.add("decimal", {later.number, 1}, later.text,
                "the file contains numbers with a decimal comma and numbers with a decimal point",
                "the other decimal mark is first used in line " +
                    std::to_string(std::min(comma_.number, point_.number)));
  }
  [[nodiscard]] bool decimal_comma() const { return comma_.number != 0; }

 private:
  /// Corrects the times of day that begin again, and adds notes about the columns of times.
  void continue_clocks() {
    bool uses_dates = true;
    for (std::size_t i = 0; i < dialect_.width; ++i) {
      const auto overflow = clocks_[i].continue_times(table_.columns[i].values, days_s_);
      if (!overflow) continue;
      table_.notes.push_back(about_overflow(table_, i, *overflow, overflow->first));
      uses_dates = uses_dates && i != time_of_day_;
    }
    if (date_column_ == dialect_.width || !date_.is_readable() || table_.columns[date_column_].bad_count > 0)
      return;
    TableColumn& dates = table_.columns[date_column_];
    dates.is_part_of_time = true;
    const TableColumn& times = table_.columns[time_of_day_];
    table_.notes.push_back(uses_dates ? about_combined_times(dates, times)
                                      : about_unused_dates(dates, times));
  }

  /// Removes the empty cell after a separator at the end of each row if the line of the names has no such
  /// cell.
  void drop_extra_cell() {
    const bool extra = dialect_.extra_cell && cells_.size() == dialect_.width + 1;
    if (extra && trimmed(cells_.back().text).empty()) cells_.pop_back();
  }

  /// Counts the empty lines and the rows in comments between the previous row and `line`. With a sampling
  /// rate, each of these lines is one sampling interval.
  void count_omitted(const TextLine& line) {
    const bool is_first = table_.account.rows == 0;
    int empty = line.empty_above - empty_above_each_;
    for (; comment_ < lines_.comments.size() && lines_.comments[comment_].number < line.number; ++comment_) {
      if (is_first || !split_line(lines_.comments[comment_].text, dialect_.separator, cells_)) continue;
      drop_extra_cell();
      if (reorders_names(cells_, dialect_)) refuse_table(lines_.comments[comment_]);
      if (!is_row(cells_, dialect_.width, options_)) continue;
      omit(LeftOut::comment);
      empty -= empty_above_each_;
    }
    cells_.clear();
    for (; !is_first && empty > 0; --empty) omit(LeftOut::empty);
  }

  /// Refuses the names of a second table. The columns below these names can have another meaning.
  void refuse_table(const TextLine& line) {
    report_.add(
        "table", {line.number, 1}, line.text,
        "a second table begins here: this line has column names or units, and they are not those of the "
        "first table",
        "split the file before this line, and import each part");
  }

  void omit(LeftOut reason) {
    ++table_.account.rows;
    table_.account.leave_out(reason);
    if (may_belong()) ++position_;
  }

  void leave_out(const TextLine& line, bool is_last, bool closed) {
    if (is_last && (cells_.size() < dialect_.width || !closed)) {
      table_.account.leave_out(LeftOut::cut_off_line);
      table_.warnings.push_back(left_out_sentence(static_cast<std::size_t>(line.number)));
    } else if (options_.skip_bad_lines) {
      table_.account.leave_out(LeftOut::bad_line);
      skipped_.push_back(line.number);
      if (may_belong()) ++position_;
    } else {
      report_.add("row", {line.number, 1}, line.text,
                  closed ? std::to_string(cells_.size()) + " cells, but the rows above have " +
                               std::to_string(dialect_.width)
                         : std::string("a quotation mark is not closed"),
                  "to leave out and count such lines, use --skip-bad-lines");
    }
  }

  /// Returns true if a line that is left out can belong to the selected finger.
  [[nodiscard]] bool may_belong() const {
    return channel_ == dialect_.width || options_.channel.empty() || channel_ >= cells_.size() ||
           cell_text(cells_[channel_].text) == options_.channel;
  }

  bool belongs() {
    if (channel_ == dialect_.width) return true;
    const std::string channel = cell_text(cells_[channel_].text);
    if (std::find(table_.channels.begin(), table_.channels.end(), channel) == table_.channels.end())
      table_.channels.push_back(channel);
    // If a column has more different values than a rig can have fingers, the column contains readings and
    // does not identify the finger.
    if (table_.channels.size() > most_fingers && !is_log_channel_ && options_.channel.empty()) {
      channel_ = dialect_.width;
      table_.channels.clear();
      table_.channel_column.clear();
    }
    return options_.channel.empty() || channel == options_.channel;
  }

  /// Finds the column of times of day that the column of dates completes. If there is none, the column of
  /// dates is a column like all others. The first row decides.
  void find_time_of_day() {
    if (date_column_ == dialect_.width) return;
    const CellValue date = cell_value(cells_[date_column_].text, options_.missing);
    const bool has_time =
        date.kind == CellKind::moment && !day_of(trimmed(unquoted(cells_[date_column_].text)));
    for (time_of_day_ = 0; time_of_day_ < dialect_.width; ++time_of_day_) {
      const CellValue cell = cell_value(cells_[time_of_day_].text, options_.missing);
      if (cell.kind == CellKind::moment && !cell.dated && !cell.short_clock) break;
    }
    if (has_time || time_of_day_ == dialect_.width) date_column_ = dialect_.width;
  }

  void read_date() {
    const std::string_view cell = cells_[date_column_].text;
    const bool missing = cell_value(cell, options_.missing).kind == CellKind::missing;
    date_.read(missing ? std::string_view() : trimmed(unquoted(cell)));
  }

  /// Refuses a change of the date that is not at midnight if the new date cannot be read.
  void check_date(const TextLine& line, bool is_midnight) {
    if (!date_.take_unread_change() || is_midnight) return;
    report_.add(
        "date", {line.number, 1}, line.text,
        "the date changes to '" + document::shown(date_.text(), 40) +
            "', and the number of days is unknown, because this date or the date before it cannot be read",
        "export the dates in a form such as 2024-05-31");
  }

  void read_cell(std::size_t i, const TextLine& line) {
    TableColumn& column = table_.columns[i];
    if (i == date_column_ && date_.is_readable()) return column.values.push_back(missing_value);
    const CellValue cell = cell_value(cells_[i].text, options_.missing);
    marks_[i].add(cell, cells_[i].text);
    if (cell.with_comma && comma_.number == 0) comma_ = line;
    if (cell.with_point && point_.number == 0) point_ = line;
    switch (cell.kind) {
      case CellKind::number:
        column.values.push_back(cell.number);
        return;
      case CellKind::moment:
        if (column.moments == 0) column.first_moment = cell.moment;
        column.short_clocks += cell.short_clock ? 1 : 0;
        column.surely_minutes = column.surely_minutes || cell.surely_minutes;
        ++column.moments;
        column.values.push_back(clocks_[i].add(cell, date_.since_first()));
        if (i == time_of_day_) check_date(line, clocks_[i].is_midnight());
        return;
      case CellKind::text:
        if (options_.skip_bad_lines) column.bad_rows.push_back(column.values.size());
        if (++column.bad_count <= bad_cells_kept)
          column.bad.push_back({column.values.size(),
                                {line.number, cells_[i].column},
                                std::string(line.text.substr(0, 200)),
                                std::string(trimmed(unquoted(cells_[i].text)))});
        break;
      case CellKind::missing:
        if (cell.missing_word >= 0) ++table_.missing_cells[static_cast<std::size_t>(cell.missing_word)];
        break;
    }
    column.values.push_back(missing_value);
  }

  std::string_view text_;
  const TextLines& lines_;
  const Dialect& dialect_;
  const TableOptions& options_;
  ForeignTable& table_;
  LogReporter& report_;
  std::vector<TextClock> clocks_;
  std::vector<DecimalMarks> marks_{dialect_.width};
  std::vector<Cell> cells_;
  std::size_t channel_ = dialect_.width;
  /// True: the column that identifies the finger has the same name as in a log.
  bool is_log_channel_ = false;
  DateColumn date_;
  std::vector<double>
      days_s_;  ///< for each row, the time between the first date and its date; empty: no dates
  std::size_t date_column_ = dialect_.width;  ///< column of dates; dialect_.width: there is no such column
  std::size_t time_of_day_ = dialect_.width;  ///< column of times of day that the dates complete
  CutOffDetector cut_off_;
  TextLine comma_;
  TextLine point_;
  std::vector<int> skipped_;
  int empty_above_each_ = empty_above_each_row(lines_, dialect_.first_row);
  std::size_t comment_ = 0;   ///< index of the first comment below the previous row
  std::size_t position_ = 0;  ///< ForeignTable::position of the next row
};

}  // namespace

std::optional<ForeignTable> parse_text_table(const std::string& file, std::string_view bytes,
                                             const TableOptions& options, document::Problems& problems) {
  const auto text = foreign_text(file, bytes, problems);
  if (!text) return std::nullopt;
  const TextLines lines = text_lines(text->text);
  const auto dialect = dialect_of(file, lines, options, problems);
  if (!dialect) return std::nullopt;
  if (lines.content.size() > most_values / std::max<std::size_t>(dialect->width, 1)) {
    problems.add({file,
                  {1, 1},
                  {},
                  "the text has more than " + std::to_string(most_values) + " values",
                  "split the file into several files"});
    return std::nullopt;
  }
  ForeignTable table;
  table.file = file;
  table.is_text = table.has_separators = true;
  table.notes = text->notes;
  LogReporter report(file, problems);
  RowReader rows(text->text, lines, *dialect, options, table, report);
  for (std::size_t i = dialect->first_row; i < lines.content.size(); ++i)
    rows.read(lines.content[i], i + 1 == lines.content.size());
  rows.finish();
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
                          " above the columns' names skipped");
  return table;
}

}  // namespace softgrip::sysid
