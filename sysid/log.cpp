#include "sysid/log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "model/document/sha256.h"
#include "sysid/files.h"
#include "sysid/log_checks.h"
#include "sysid/numbers.h"

namespace softgrip::sysid {
namespace {

using document::Location;
using document::Problem;
using document::Problems;

constexpr double no_reading = std::numeric_limits<double>::quiet_NaN();

/// A column of the contract.
struct Known {
  std::string_view name;
  std::string_view quantity;  ///< the name without its unit
  bool required;
  bool may_be_empty;  ///< an empty cell says: no reading
  std::vector<double> Log::*values;
};

const std::array<Known, 6> known_columns{{
    {"time_s", "time", true, false, &Log::time_s},
    {"pressure_command_kpa", "pressure_command", true, false, &Log::pressure_command_kpa},
    {"displacement_mm", "displacement", true, true, &Log::displacement_mm},
    {"pressure_kpa", "pressure", false, true, &Log::pressure_kpa},
    {"temperature_c", "temperature", false, true, &Log::temperature_c},
    {"supply_kpa", "supply", false, true, &Log::supply_kpa},
}};
constexpr std::size_t column_time = 0;
constexpr std::size_t column_command = 1;
constexpr std::size_t column_displacement = 2;
constexpr std::string_view channel_column = "channel";

/// How to come from a unit that people write to the one of the contract.
std::string conversion(std::string_view unit) {
  static const std::map<std::string_view, std::string_view> conversions{
      {"ms", "divide by 1000"},        {"us", "divide by 1e6"},    {"ns", "divide by 1e9"},
      {"min", "multiply by 60"},       {"bar", "multiply by 100"}, {"mbar", "divide by 10"},
      {"psi", "multiply by 6.894757"}, {"pa", "divide by 1000"},   {"mpa", "multiply by 1000"},
      {"m", "multiply by 1000"},       {"um", "divide by 1000"},   {"cm", "multiply by 10"},
      {"in", "multiply by 25.4"},      {"k", "subtract 273.15"},   {"f", "(f - 32) / 1.8"}};
  const auto found = conversions.find(unit);
  return found == conversions.end() ? std::string() : ", " + std::string(found->second);
}

/// The text, line by line, without line breaks.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

/// A cell and the byte column at which it stands.
struct Cell {
  std::string_view text;
  int column;
};

/// Splits at commas outside double quotes. The cells keep their quotes.
void split(std::string_view line, std::vector<Cell>& cells) {
  cells.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i == line.size() || (line[i] == ',' && !quoted)) {
      cells.push_back({line.substr(begin, i - begin), static_cast<int>(begin) + 1});
      begin = i + 1;
    }
  }
}

std::string_view unquoted(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  return text;
}

/// Adds the first few problems of each kind and counts the rest.
class Reporter {
 public:
  Reporter(std::string file, Problems& problems) : file_(std::move(file)), problems_(problems) {}

  void add(const std::string& kind, Location at, std::string_view line, std::string message,
           std::string hint = {}) {
    constexpr int shown = 3;
    if (int& count = counts_[kind]; ++count <= shown) {
      problems_.add({file_, at, std::string(line.substr(0, 200)), std::move(message), std::move(hint)});
    } else {
      last_[kind] = {at, std::string(line.substr(0, 200))};
    }
  }
  /// One line per kind for those not shown.
  void finish() {
    for (const auto& [kind, last] : last_) {
      problems_.add({file_,
                     last.first,
                     last.second,
                     kind + ": " + std::to_string(counts_[kind] - 3) + " more, the last one here",
                     {}});
    }
    last_.clear();
  }
  [[nodiscard]] bool any() const { return !counts_.empty(); }

 private:
  std::string file_;
  Problems& problems_;
  std::map<std::string, int> counts_;
  std::map<std::string, std::pair<Location, std::string>> last_;
};

/// Where the columns of a log stand in its rows.
struct Header {
  std::vector<std::string> names;
  std::array<int, known_columns.size()> index{};  ///< -1: absent
  std::array<int, known_columns.size()> column{};
  int channel = -1;
};

/// Says which column of the contract a foreign name was probably meant to be.
void report_near_miss(const Cell& cell, std::string_view name, std::string_view line, Reporter& report) {
  for (const Known& known : known_columns) {
    const std::string_view unit = known.name.substr(known.quantity.size() + 1);
    const bool bare = name == known.quantity;
    const bool other_unit = name.size() > known.quantity.size() + 1 && name.starts_with(known.quantity) &&
                            name[known.quantity.size()] == '_' &&
                            !conversion(name.substr(known.quantity.size() + 1)).empty();
    if (!bare && !other_unit) continue;
    const std::string expected = "expected '" + std::string(known.name) + "'";
    if (bare) {
      report.add("unit", {1, cell.column}, line, "column '" + std::string(name) + "' says no unit",
                 expected + ", in " + std::string(unit));
    } else {
      report.add("unit", {1, cell.column}, line, "column '" + std::string(name) + "' has the wrong unit",
                 expected + conversion(name.substr(known.quantity.size() + 1)));
    }
    return;
  }
}

/// Checks what the header's line says before its names are looked at.
bool header_is_plausible(std::string_view line, const std::vector<Cell>& cells, Reporter& report) {
  if (cells.size() == 1 && line.find(';') != std::string_view::npos) {
    report.add("separator", {1, static_cast<int>(line.find(';')) + 1}, line,
               "the columns are separated by ';'", "a log is separated by ',' with '.' in numbers");
    return false;
  }
  if (cells.size() == 1 && line.find('\t') != std::string_view::npos) {
    report.add("separator", {1, static_cast<int>(line.find('\t')) + 1}, line,
               "the columns are separated by tabs", "a log is separated by ','");
    return false;
  }
  if (std::all_of(cells.begin(), cells.end(), [](const Cell& c) { return to_number(c.text).has_value(); })) {
    report.add("header", {1, 1}, line, "the first line holds numbers instead of column names",
               "write 'time_s,pressure_command_kpa,displacement_mm' above it");
    return false;
  }
  return true;
}

Header read_header(std::string_view line, const LogOptions& options, Reporter& report) {
  Header header;
  header.index.fill(-1);
  header.column.fill(1);
  std::vector<Cell> cells;
  split(line, cells);
  if (!header_is_plausible(line, cells, report)) return header;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name(unquoted(cells[i].text));
    const auto known = std::find_if(known_columns.begin(), known_columns.end(),
                                    [&](const Known& k) { return k.name == name; });
    const bool repeated =
        !name.empty() && std::find(header.names.begin(), header.names.end(), name) != header.names.end();
    if (repeated) {
      report.add("duplicate", {1, cells[i].column}, line, "column '" + name + "' stands twice", {});
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
  for (std::size_t k = 0; k < known_columns.size(); ++k) {
    if (!known_columns[k].required || header.index[k] >= 0) continue;
    if (k == column_displacement && !options.need_readings) continue;
    const std::string near = document::nearest(known_columns[k].name, header.names);
    report.add("missing", {1, 1}, line, "column '" + std::string(known_columns[k].name) + "' is missing",
               near.empty() ? std::string() : "is it '" + near + "'?");
  }
  return header;
}

/// One number of a row, reported where it is none.
double read_cell(const Known& known, const Cell& cell, int line_number, std::string_view line,
                 Reporter& report) {
  const std::string_view text = unquoted(cell.text);
  const Location at{line_number, cell.column};
  const std::string column = "'" + std::string(known.name) + "'";
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
               known.may_be_empty ? "leave the cell empty where there was no reading" : "");
    return no_reading;
  }
  return *value;
}

/// The rows of one channel, read into a log.
class RowReader {
 public:
  RowReader(const Header& header, const LogOptions& options, Log& log, LogSource& source, Reporter& report)
      : header_(header), options_(options), log_(log), source_(source), report_(report) {
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
    split(line, cells_);
    if (cells_.size() != header_.names.size()) {
      if (is_last && cells_.size() < header_.names.size()) {
        log_.notes.push_back({line_number, "the last row is incomplete and was left out"});
        return;
      }
      report_.add("row", {line_number, 1}, line,
                  std::to_string(cells_.size()) + " cells where the header has " +
                      std::to_string(header_.names.size()),
                  cells_.size() == 2 * header_.names.size() ? "numbers with a decimal comma?" : "");
      return;
    }
    if (!belongs()) return;
    for (std::size_t k = 0; k < known_columns.size(); ++k) {
      if (header_.index[k] < 0) continue;
      const Cell& cell = cells_[static_cast<std::size_t>(header_.index[k])];
      (log_.*known_columns[k].values)
          .push_back(read_cell(known_columns[k], cell, line_number, line, report_));
    }
    for (std::size_t i = 0; i < other_index_.size(); ++i) {
      log_.others[i].cells.emplace_back(unquoted(cells_[other_index_[i]].text));
    }
    source_.line.push_back(line_number);
    source_.line_text.push_back(line);
  }

  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }

 private:
  bool belongs() {
    if (header_.channel < 0) return true;
    const std::string_view channel = unquoted(cells_[static_cast<std::size_t>(header_.channel)].text);
    if (std::find(channels_.begin(), channels_.end(), channel) == channels_.end()) {
      channels_.emplace_back(channel);
    }
    return options_.channel.empty() ? channel == channels_.front() : channel == options_.channel;
  }

  const Header& header_;
  const LogOptions& options_;
  Log& log_;
  LogSource& source_;
  Reporter& report_;
  std::vector<Cell> cells_;
  std::vector<std::size_t> other_index_;
  std::vector<std::string> channels_;
};

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "'" : ", '") + word + "'";
  return list;
}

/// A log with several channels needs a choice, and the choice must exist.
void check_channel(const RowReader& rows, const Header& header, const LogOptions& options,
                   std::string_view header_line, Reporter& report, Log& log) {
  const Location at{1, 1};
  if (header.channel < 0) {
    if (!options.channel.empty()) {
      report.add("channel", at, header_line,
                 "channel '" + options.channel + "' was asked for, and the log has no channel column");
    }
    return;
  }
  const auto& channels = rows.channels();
  if (options.channel.empty() && channels.size() > 1) {
    report.add("channel", at, header_line,
               "the log holds " + std::to_string(channels.size()) + " channels: " + listed(channels),
               "say which one with --channel");
  } else if (!options.channel.empty() &&
             std::find(channels.begin(), channels.end(), options.channel) == channels.end()) {
    report.add("channel", at, header_line,
               "no channel '" + options.channel + "' in the log, which has " + listed(channels));
  }
  log.channel = options.channel.empty() && !channels.empty() ? channels.front() : options.channel;
}

bool is_text(std::string_view text, Reporter& report) {
  const std::size_t zero = text.find('\0');
  if (zero == std::string_view::npos) return true;
  const auto line = static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(zero), '\n'));
  const bool wide = text.size() > 1 && (text[0] == '\xff' || text[0] == '\xfe');
  report.add("binary", {line + 1, 1}, {}, "a byte 0: this is not a CSV text",
             wide ? "it looks like UTF-16: save it as UTF-8" : "");
  return false;
}

}  // namespace

std::optional<Log> parse_log(const std::string& file, std::string_view text, Problems& problems,
                             const LogOptions& options) {
  Reporter report(file, problems);
  Log log;
  log.path = file;
  log.sha256 = document::sha256(text);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  if (!is_text(text, report)) return std::nullopt;
  const std::vector<std::string_view> lines = lines_of(text);
  if (lines.empty()) {
    report.add("empty", {1, 1}, {}, "the log is empty");
    return std::nullopt;
  }
  const Header header = read_header(lines.front(), options, report);
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
  RowReader rows(header, options, log, source, report);
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

namespace {

/// Reports and JSON speak of logs by name: the second of a name becomes "run (2)".
void make_names_unique(std::vector<Log>& logs) {
  std::map<std::string, int> seen;
  for (Log& log : logs) {
    if (const int count = ++seen[log.name]; count > 1) log.name += " (" + std::to_string(count) + ")";
  }
}

}  // namespace

Campaign read_campaign(const std::vector<std::string>& paths, Problems& problems, const LogOptions& options) {
  namespace fs = std::filesystem;
  Campaign campaign;
  for (const std::string& given : paths) {
    std::error_code error;
    const bool folder = fs::is_directory(given, error);
    const std::string path = folder ? (fs::path(given) / "run.csv").string() : given;
    const auto text = read_file(path, options.bytes);
    if (!text) {
      problems.add({path, {1, 1}, {}, text.error(), {}});
      campaign.unreadable = true;
      continue;
    }
    auto log = parse_log(path, *text, problems, options);
    if (!log) continue;
    if (folder) {
      const fs::path run = fs::path(given).lexically_normal();
      log->name = (run.has_filename() ? run.filename() : run.parent_path().filename()).string() +
                  (log->channel.empty() ? "" : "/" + log->channel);
    }
    campaign.logs.push_back(std::move(*log));
  }
  make_names_unique(campaign.logs);
  return campaign;
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
      const std::string_view channel = unquoted(cells[*place].text);
      if (std::find(channels.begin(), channels.end(), channel) == channels.end())
        channels.emplace_back(channel);
    }
  }
  return channels;
}

std::string format_log(const Log& log) {
  std::string text;
  std::vector<const Known*> present;
  for (const Known& known : known_columns) {
    if (!(log.*known.values).empty() || known.required) present.push_back(&known);
  }
  for (const Known* known : present) text += (text.empty() ? "" : ",") + std::string(known->name);
  if (!log.channel.empty()) text += ',' + std::string(channel_column);
  for (const OtherColumn& other : log.others) text += ',' + other.name;
  text += '\n';
  text.reserve(log.size() * present.size() * 20);
  for (std::size_t i = 0; i < log.size(); ++i) {
    bool first = true;
    for (const Known* known : present) {
      const double value = (log.*known->values)[i];
      if (!first) text += ',';
      if (std::isfinite(value)) text += shortest(value);
      first = false;
    }
    if (!log.channel.empty()) text += ',' + log.channel;
    for (const OtherColumn& other : log.others) {
      const bool quotes = other.cells[i].find(',') != std::string::npos;
      text += quotes ? ",\"" + other.cells[i] + "\"" : "," + other.cells[i];
    }
    text += '\n';
  }
  return text;
}

Sampling sampling_of(const Log& log) {
  Sampling sampling;
  std::vector<double> intervals(log.size());
  std::adjacent_difference(log.time_s.begin(), log.time_s.end(), intervals.begin());
  intervals.erase(intervals.begin());
  if (intervals.empty()) return sampling;
  auto sorted = intervals;
  std::sort(sorted.begin(), sorted.end());
  sampling.median_interval_s = sorted[sorted.size() / 2];
  sampling.shortest_interval_s = sorted.front();
  sampling.longest_interval_s = sorted.back();
  for (const double interval : intervals)
    sampling.jitter_s += std::abs(interval - sampling.median_interval_s);
  sampling.jitter_s /= static_cast<double>(intervals.size());
  const double tolerance = 1e-3 * sampling.median_interval_s;
  sampling.regular = sampling.longest_interval_s - sampling.shortest_interval_s <= 2 * tolerance;
  return sampling;
}

double span_mm(const Log& log) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const double value : log.displacement_mm) {
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  return highest < lowest ? 0 : highest - lowest;
}

Log slice(const Log& log, std::size_t first, std::size_t last) {
  const auto cut = [&](const auto& values) {
    using Values = std::decay_t<decltype(values)>;
    if (values.empty()) return Values{};
    return Values(values.begin() + static_cast<long>(first), values.begin() + static_cast<long>(last));
  };
  Log part;
  part.path = log.path;
  part.name = log.name;
  part.channel = log.channel;
  part.sha256 = log.sha256;
  for (const Known& known : known_columns) part.*known.values = cut(log.*known.values);
  for (const OtherColumn& other : log.others) part.others.push_back({other.name, cut(other.cells)});
  for (double& time : part.time_s) time -= log.time_s[first];
  return part;
}

}  // namespace softgrip::sysid
