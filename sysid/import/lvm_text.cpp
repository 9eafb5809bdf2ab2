#include "sysid/import/table_readers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "sysid/import/cell_value.h"
#include "sysid/import/moments.h"
#include "sysid/import/text_dialect.h"
#include "sysid/import/units.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {
namespace {

constexpr std::string_view end_of_header = "***End_of_Header***";

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  std::vector<std::string> texts;
  (void)split(line, cells, separator);
  texts.reserve(cells.size());
  for (const Cell& cell : cells) texts.emplace_back(trimmed(cell_text(cell.text)));
  return texts;
}

/// The values of each key in a header. A line of the header has the form "KEY value value ...".
using Header = std::map<std::string, std::vector<std::string>>;

class LvmReader {
 public:
  LvmReader(const std::string& file, const TableOptions& options, document::Problems& problems)
      : options_(options), problems_(problems) {
    table_.file = file;
    table_.is_text = true;
    table_.missing_cells.resize(options.missing.size());
  }

  std::optional<ForeignTable> read(const ForeignText& text) {
    const std::vector<std::string_view> lines = lines_of(text.text);
    lines_ = lines.size();
    table_.notes = text.notes;
    std::size_t at = 0;
    const Header file_header = header(lines, at);
    if (separator_ == decimal_)
      return refuse(decimal_line_,
                    "the header states that commas separate the columns and that the numbers have decimal "
                    "commas, so the numbers cannot be read");
    x_columns_ = lower_case(first_of(file_header, "X_Columns"));
    int sections = 0;
    while (at < lines.size() && good_) {
      if (trimmed(lines[at]).empty()) {
        ++at;
        continue;
      }
      section(lines, at);
      ++sections;
    }
    if (!good_) return std::nullopt;
    if (short_line_ != 0 && !options_.skip_bad_lines)
      table_.warnings.push_back(left_out_sentence(short_line_));
    if (table_.columns.empty() || table_.rows() == 0) return refuse(1, "the LabVIEW measurement has no rows");
    table_.format = "LabVIEW measurement, " + std::to_string(sections) +
                    (sections == 1 ? " section" : " sections") + (separator_ == '\t' ? "" : ", commas");
    return std::move(table_);
  }

 private:
  std::nullopt_t refuse(std::size_t line, const std::string& message) {
    problems_.add({table_.file, {static_cast<int>(line), 1}, {}, message, "export the data as CSV"});
    good_ = false;
    return std::nullopt;
  }

  static std::string first_of(const Header& header, const std::string& key) {
    const auto found = header.find(key);
    return found == header.end() || found->second.empty() ? std::string() : found->second.front();
  }

  /// Returns the values that the header contains for a key, one per channel. If each channel has its own X
  /// column, the header line also has an empty cell for each X column. These empty cells are skipped.
  [[nodiscard]] std::vector<std::string> of_channels(const Header& header, const std::string& key) const {
    const auto found = header.find(key);
    if (found == header.end()) return {};
    std::vector<std::string> values;
    for (std::size_t i = 0; i < found->second.size(); ++i) {
      const std::string& value = found->second[i];
      if (i % 2 == 0 || x_columns_ != "multi") values.push_back(value);
      if (i % 2 == 1 && x_columns_ == "multi" && !value.empty()) return found->second;
    }
    return values;
  }

  /// Returns the start time of each channel. A channel without a start time gets the start time of the first
  /// channel.
  [[nodiscard]] std::vector<Nanoseconds> starts_of(const Header& section) const {
    const std::vector<std::string> dates = of_channels(section, "Date");
    const std::vector<std::string> times = of_channels(section, "Time");
    std::vector<Nanoseconds> starts;
    for (std::size_t k = 0; k < std::min(dates.size(), times.size()); ++k) {
      const auto moment = moment_of(dates[k] + " " + times[k]);
      if (!moment && starts.empty()) return {};
      starts.push_back(moment ? moment->time : starts.front());
    }
    return starts;
  }

  /// If the channels share one X column, checks that they have equal X0, Delta_X and start times. This check
  /// is necessary because the times of the first channel are used for all channels.
  bool has_one_clock(const Header& section, std::size_t line) {
    if (x_columns_ == "multi") return true;
    for (const char* const key : {"Delta_X", "X0"}) {
      const std::vector<std::string> values = of_channels(section, key);
      for (const std::string& value : values) {
        if (std::isfinite(number(values.front())) && !value.empty() &&
            number(value) != number(values.front()))
          refuse(line, "the channels share one X column, but differ in " + std::string(key) + ": " +
                           values.front() + " and " + value);
        if (!good_) return false;
      }
    }
    const double delta_s = number(first_of(section, "Delta_X"));
    const std::vector<Nanoseconds> starts = starts_of(section);
    for (const Nanoseconds start : starts) {
      const double apart_s = std::abs(seconds(start - starts.front()));
      if (!(apart_s > 0.5 * delta_s)) continue;
      refuse(line,
             "the channels share one X column, but begin " + significant(apart_s) + " s apart (Date, Time)");
      return false;
    }
    return true;
  }

  /// Adds to the X values of each channel the difference between the start times of this channel and the
  /// first channel.
  void shift_starts(const Header& section, std::size_t begin) {
    const std::vector<Nanoseconds> starts = starts_of(section);
    for (std::size_t k = 1; k < starts.size() && x_columns_ == "multi"; ++k) {
      const double apart_s = seconds(starts[k] - starts.front());
      if (apart_s == 0 || 2 * k >= table_.columns.size()) continue;
      std::vector<double>& x = table_.columns[2 * k].values;
      for (std::size_t i = begin; i < x.size(); ++i) x[i] += apart_s;
      table_.notes.push_back("channel " + std::to_string(k + 1) + " begins " + significant(apart_s) +
                             " s after the first channel (Date, Time)");
    }
  }

  /// Replaces the decimal mark of the file by a point.
  [[nodiscard]] std::string pointed(std::string text) const {
    if (decimal_ == ',') std::replace(text.begin(), text.end(), ',', '.');
    return text;
  }

  [[nodiscard]] double number(const std::string& text) const {
    return to_number(pointed(text)).value_or(missing_value);
  }

  Header header(const std::vector<std::string_view>& lines, std::size_t& at) {
    Header header;
    for (; at < lines.size(); ++at) {
      if (trimmed(lines[at]).starts_with(end_of_header)) {
        ++at;
        break;
      }
      std::vector<std::string> cells = cells_of(lines[at], separator_);
      const std::string key = cells.front();
      cells.erase(cells.begin());
      if (key == "Separator" && lower_case(cells.empty() ? "" : cells.front()) == "comma") separator_ = ',';
      if (key == "Decimal_Separator") read_decimal_mark(lines[at].substr(lines[at].find(key)), at + 1);
      if (!key.empty()) header[key] = std::move(cells);
    }
    return header;
  }

  /// Reads the decimal mark from its line of the header. The mark follows the key and one separator, because
  /// the mark can be the separator itself.
  void read_decimal_mark(std::string_view line, std::size_t number_of_line) {
    const std::size_t at = std::string_view("Decimal_Separator").size() + 1;
    if (at >= line.size() || trimmed(line.substr(at)).empty()) return;
    decimal_ = trimmed(line.substr(at)).front();
    decimal_line_ = number_of_line;
  }

  void section(const std::vector<std::string_view>& lines, std::size_t& at) {
    const bool has_header = trimmed(lines[at]).starts_with("Channels");
    const Header section = has_header ? header(lines, at) : Header{};
    if (at >= lines.size()) return;
    const std::size_t names_line = at;
    std::vector<std::string> names = cells_of(lines[at++], separator_);
    has_comments_ = !names.empty() && names.back() == "Comment";
    if (has_comments_) names.pop_back();
    if (!take_names(names, section, names_line + 1) || !has_one_clock(section, names_line + 1)) return;
    const double x0 = number(first_of(section, "X0"));
    const double delta = number(first_of(section, "Delta_X"));
    const std::size_t begin = table_.rows();
    for (std::size_t row = 0; at < lines.size() && good_; ++at) {
      const std::string_view line = trimmed(lines[at]);
      if (line.empty()) continue;
      if (line.starts_with("Channels")) break;
      add_row(lines[at], at + 1, x0 + static_cast<double>(row++) * delta);
    }
    shift_starts(section, begin);
    place(section, begin, delta);
  }

  /// Shifts the X values of a section if they start at or below the last X value of the previous section. The
  /// shifted section begins at the time in its header. If this time is missing or too early, the section
  /// begins one step after the last X value.
  void place(const Header& section, std::size_t begin, double delta) {
    const auto moment = moment_of(first_of(section, "Date") + " " + first_of(section, "Time"));
    if (begin == 0 && moment) first_moment_ = moment->time;
    if (begin == 0 || begin == table_.rows()) return;
    for (TableColumn& column : table_.columns) {
      std::vector<double>& x = column.values;
      if (!column.name.starts_with("X_Value") || !(x[begin] <= x[begin - 1])) continue;
      const double apart_s = moment ? seconds(moment->time - first_moment_) : 0;
      const bool has_time = x[begin] + apart_s > x[begin - 1];
      const double shift = has_time ? apart_s : x[begin - 1] + delta - x[begin];
      for (std::size_t i = begin; i < x.size(); ++i) x[i] += shift;
      table_.notes.push_back(
          "the times restart in line " + std::to_string(table_.line[begin]) +
          (has_time ? ": the section begins at the Date and Time of its header"
                    : ": the section begins one sample interval after the end of the previous section"));
    }
  }

  bool take_names(const std::vector<std::string>& names, const Header& section, std::size_t line) {
    if (!table_.columns.empty()) {
      const bool same =
          names.size() == table_.columns.size() &&
          std::equal(names.begin(), names.end(), table_.columns.begin(),
                     [](const std::string& name, const TableColumn& c) { return c.name == name; });
      if (!same) refuse(line, "the columns of this section differ from the columns of the first section");
      return same;
    }
    if (names.size() > most_values / lines_) {
      refuse(line, "the text has more than " + std::to_string(most_values) + " values");
      return false;
    }
    const std::vector<std::string> units = of_channels(section, "Y_Unit_Label");
    for (std::size_t i = 0; i < names.size(); ++i) {
      TableColumn column;
      column.name = names[i];
      const std::size_t channel = x_columns_ == "multi" ? i / 2 : i - 1;
      const bool is_x = names[i].starts_with("X_Value");
      if (is_x) column.unit = "s";
      if (!is_x && split_unit(names[i]).unit.empty() && channel < units.size()) column.unit = units[channel];
      table_.columns.push_back(std::move(column));
    }
    return true;
  }

  void add_row(std::string_view line, std::size_t number_of_line, double counted_x) {
    ++table_.account.rows;
    // Only the last line of a file may have too few cells, because an interrupted recording can end within a
    // line.
    if (short_line_ != 0 && !options_.skip_bad_lines) {
      refuse(short_line_, "this line has too few cells; to leave out such lines, use --skip-bad-lines");
      return;
    }
    std::vector<std::string> cells = cells_of(line, separator_);
    const std::size_t most = table_.columns.size() + (has_comments_ ? 1 : 0);
    while (cells.size() > most && cells.back().empty()) cells.pop_back();
    if (cells.size() > most) return leave_out_long(number_of_line, cells.size());
    if (cells.size() < table_.columns.size()) {
      table_.account.leave_out(options_.skip_bad_lines ? LeftOut::bad_line : LeftOut::cut_off_line);
      short_line_ = number_of_line;
      return;
    }
    for (std::size_t i = 0; i < table_.columns.size(); ++i) add_cell(i, cells[i], number_of_line, counted_x);
    table_.line.push_back(static_cast<int>(number_of_line));
    table_.position.push_back(table_.account.rows - 1);
  }

  /// Leaves out a line with too many cells, or refuses the file.
  void leave_out_long(std::size_t number_of_line, std::size_t cells) {
    if (options_.skip_bad_lines) return table_.account.leave_out(LeftOut::bad_line);
    refuse(number_of_line, "this line has " + std::to_string(cells) + " cells, but the table has " +
                               std::to_string(table_.columns.size()) +
                               " columns; to leave out such lines, use --skip-bad-lines");
  }

  void add_cell(std::size_t i, const std::string& text, std::size_t line, double counted_x) {
    TableColumn& column = table_.columns[i];
    // If a channel has ended before another channel, the remaining cells of its X column are empty.
    const bool may_count = x_columns_ == "no" || (text.empty() && x_columns_ != "multi");
    const bool counts = may_count && column.name.starts_with("X_Value");
    const CellValue cell = cell_value(pointed(text), options_.missing);
    if (cell.missing_word >= 0) ++table_.missing_cells[static_cast<std::size_t>(cell.missing_word)];
    if (cell.kind == CellKind::text || cell.kind == CellKind::moment) {
      column.bad_rows.push_back(column.values.size());
      if (++column.bad_count <= 3)
        column.bad.push_back({column.values.size(), {static_cast<int>(line), 1}, text, text});
    }
    const double value = cell.kind == CellKind::number ? cell.number : missing_value;
    column.values.push_back(counts && std::isfinite(counted_x) ? counted_x : value);
  }

  const TableOptions& options_;
  document::Problems& problems_;
  ForeignTable table_;
  std::string x_columns_;
  char separator_ = '\t';
  char decimal_ = '.';
  std::size_t decimal_line_ = 1;  ///< number of the line that states the decimal mark
  bool has_comments_ = false;     ///< true: each row of the current section can end with a comment
  Nanoseconds first_moment_ = 0;
  std::size_t lines_ = 1;  ///< number of lines in the file
  /// Number of the first line that has too few cells; 0: all lines are complete.
  std::size_t short_line_ = 0;
  bool good_ = true;
};

}  // namespace

bool is_lvm(std::string_view text) {
  return text.starts_with("LabVIEW Measurement") && text.find(end_of_header) != std::string_view::npos &&
         text.find("\nX_Columns") != std::string_view::npos;
}

std::optional<ForeignTable> read_lvm(const std::string& file, std::string_view bytes,
                                     const TableOptions& options, document::Problems& problems) {
  const auto text = foreign_text(file, bytes, problems);
  return text ? LvmReader(file, options, problems).read(*text) : std::nullopt;
}

}  // namespace softgrip::sysid
