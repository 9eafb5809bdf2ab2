// Reads logs from text. Implements parse_log() and channels_of() of sysid/logs/log.h.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/numbers.h"
#include "base/sha256.h"
#include "base/text.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/log.h"
#include "sysid/logs/log_header.h"

namespace softgrip::sysid {
namespace {

constexpr double no_reading = std::numeric_limits<double>::quiet_NaN();

/// Returns the number in a cell. Reports an error if the cell does not contain a number.
double read_cell(const KnownColumn& known, std::string_view name, const Cell& cell, int line_number,
                 std::string_view line, LogReporter& report) {
  const std::string_view text = unquoted(cell.text);
  const document::Location at{line_number, cell.column};
  const std::string column = "'" + std::string(name) + "'";
  if (text.empty()) {
    if (known.may_be_empty) return no_reading;
    report.add("empty cell", at, line, "no number in column " + column);
    return no_reading;
  }
  const auto value = to_number(text);
  if (!value) {
    report.add("not a number", at, line,
               "'" + std::string(text.substr(0, 40)) + "' in column " + column + " is not a number");
    return no_reading;
  }
  if (!std::isfinite(*value)) {
    report.add("not finite", at, line, "'" + std::string(text) + "' in column " + column,
               known.may_be_empty ? "if there was no reading, leave the cell empty" : "");
    return no_reading;
  }
  return *value;
}

/// Reads the rows of one channel into a log.
class RowReader {
 public:
  /// @param text  the whole text, of which the rows are parts.
  RowReader(std::string_view text, const LogHeader& header, const LogOptions& options, Log& log,
            LogSource& source, LogReporter& report)
      : text_(text), header_(header), options_(options), log_(log), source_(source), report_(report) {
    for (std::size_t i = 0; i < header.names.size(); ++i) {
      const bool is_known =
          std::find(header.index.begin(), header.index.end(), static_cast<int>(i)) != header.index.end() ||
          static_cast<int>(i) == header.channel;
      if (is_known) continue;
      other_index_.push_back(i);
      log_.others.push_back({header.names[i], {}});
    }
  }

  void read(std::string_view line, int line_number, bool is_last) {
    const bool closed = split(line, cells_);
    if (cells_.size() != header_.names.size()) {
      if (is_last && cells_.size() < header_.names.size()) {
        log_.notes.push_back({line_number, "the last row is incomplete and was left out"});
        return;
      }
      report_.add("row", {line_number, 1}, line,
                  std::to_string(cells_.size()) + " cells, but the header has " +
                      std::to_string(header_.names.size()),
                  cells_.size() == 2 * header_.names.size()
                      ? "if the numbers have a decimal comma, use a decimal point"
                      : "");
      return;
    }
    if (!closed) {
      if (is_last) {
        log_.notes.push_back({line_number, "the last row is incomplete and was left out"});
        return;
      }
      report_.add("row", {line_number, 1}, line, "a quotation mark is not closed");
      return;
    }
    cut_off_.add(line, cells_.back().text);
    if (is_last && cut_off_.may_be_cut_off(text_))
      log_.notes.push_back({line_number, cut_off_sentence(cells_.back().text)});
    if (!belongs()) return;
    for (std::size_t k = 0; k < known_columns.size(); ++k) {
      if (header_.index[k] < 0) continue;
      const Cell& cell = cells_[static_cast<std::size_t>(header_.index[k])];
      const bool reading = k == column_displacement;
      const double value = read_cell(known_columns[k], reading ? header_.reading.name : known_columns[k].name,
                                     cell, line_number, line, report_);
      (log_.*known_columns[k].values).push_back(reading ? in_output_unit(value) : value);
    }
    for (std::size_t i = 0; i < other_index_.size(); ++i) {
      log_.others[i].cells.push_back(cell_text(cells_[other_index_[i]].text));
    }
    source_.line.push_back(line_number);
    source_.line_text.push_back(line);
  }

  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }

 private:
  /// Converts a reading to the unit of the log. If the result is too large for a double, the function returns
  /// the unconverted value. The check of the largest reading then refuses this value.
  [[nodiscard]] double in_output_unit(double value) const {
    const double converted = header_.reading.factor * value;
    return std::isfinite(converted) ? converted : value;
  }

  bool belongs() {
    if (header_.channel < 0) return true;
    const std::string channel = cell_text(cells_[static_cast<std::size_t>(header_.channel)].text);
    if (std::find(channels_.begin(), channels_.end(), channel) == channels_.end()) {
      channels_.push_back(channel);
    }
    return options_.channel.empty() ? channel == channels_.front() : channel == options_.channel;
  }

  std::string_view text_;
  const LogHeader& header_;
  const LogOptions& options_;
  Log& log_;
  LogSource& source_;
  LogReporter& report_;
  CutOffDetector cut_off_;
  std::vector<Cell> cells_;
  std::vector<std::size_t> other_index_;
  std::vector<std::string> channels_;
};

std::string listed(const std::vector<std::string>& words) {
  return with_commas(words, [](const std::string& word) { return "'" + word + "'"; });
}

/// Reports an error if a log has several channels and none is selected, or if the selected channel does not
/// exist.
void check_channel(const RowReader& rows, const LogHeader& header, const LogOptions& options,
                   std::string_view header_line, LogReporter& report, Log& log) {
  const document::Location at{1, 1};
  if (header.channel < 0) {
    if (!options.channel.empty()) {
      report.add("channel", at, header_line,
                 "channel '" + options.channel + "' was requested, but the log has no column 'channel'");
    }
    return;
  }
  const auto& channels = rows.channels();
  if (options.channel.empty() && channels.size() > 1) {
    report.add("channel", at, header_line,
               "the log has " + std::to_string(channels.size()) + " channels: " + listed(channels),
               "select one channel with --channel");
  } else if (!options.channel.empty() &&
             std::find(channels.begin(), channels.end(), options.channel) == channels.end()) {
    report.add("channel", at, header_line,
               "no channel '" + options.channel + "' in the log, which has " + listed(channels));
  }
  log.channel = options.channel.empty() && !channels.empty() ? channels.front() : options.channel;
}

bool is_text(std::string_view text, LogReporter& report) {
  const std::size_t zero = text.find('\0');
  if (zero == std::string_view::npos) return true;
  const auto line = static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(zero), '\n'));
  const bool wide = text.size() > 1 && (text[0] == '\xff' || text[0] == '\xfe');
  report.add("binary", {line + 1, 1}, {}, "the file contains a byte 0, so the file is not a CSV text",
             wide ? "the file seems to be in UTF-16: save the file as UTF-8" : "");
  return false;
}

}  // namespace

std::optional<Log> parse_log(const std::string& file, std::string_view text, document::Problems& problems,
                             const LogOptions& options) {
  LogReporter report(file, problems);
  Log log;
  log.path = file;
  log.sha256 = sha256(text);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  if (!is_text(text, report)) return std::nullopt;
  const std::vector<std::string_view> lines = lines_of(text);
  if (lines.empty()) {
    report.add("empty", {1, 1}, {}, "the log is empty");
    return std::nullopt;
  }
  const LogHeader header = read_header(lines.front(), options, report);
  if (report.any()) {
    report.finish();
    return std::nullopt;
  }
  LogSource source{file,
                   {},
                   {},
                   header.column[column_time],
                   header.column[column_command],
                   header.column[column_displacement]};
  log.output_unit = header.reading.unit;
  RowReader rows(text, header, options, log, source, report);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    rows.read(lines[i], static_cast<int>(i) + 1, i + 1 == lines.size());
  }
  if (header.index[column_displacement] < 0) log.displacement_mm.assign(log.size(), no_reading);
  check_channel(rows, header, options, lines.front(), report, log);
  log.name = std::filesystem::path(file).stem().string();
  if (!log.channel.empty()) log.name += "/" + log.channel;
  report.finish();
  if (report.any()) return std::nullopt;
  const std::size_t before = problems.size();
  check_log(log, source, options, problems);
  if (problems.size() != before) return std::nullopt;
  return log;
}

std::vector<std::string> channels_of(std::string_view text) {
  std::vector<std::string> channels;
  std::vector<Cell> cells;
  std::optional<std::size_t> place;
  for (const std::string_view line : lines_of(text)) {
    split(line, cells);
    if (!place) {
      const auto found = std::find_if(cells.begin(), cells.end(),
                                      [](const Cell& cell) { return unquoted(cell.text) == channel_column; });
      if (found == cells.end()) break;
      place = static_cast<std::size_t>(found - cells.begin());
    } else if (*place < cells.size()) {
      const std::string channel = cell_text(cells[*place].text);
      if (std::find(channels.begin(), channels.end(), channel) == channels.end()) channels.push_back(channel);
    }
  }
  return channels;
}

}  // namespace softgrip::sysid
