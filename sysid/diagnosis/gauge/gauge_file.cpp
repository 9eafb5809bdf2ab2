#include "sysid/diagnosis/gauge/gauge_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/files.h"
#include "base/numbers.h"
#include "base/sha256.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t most_bytes = std::size_t{16} * 1024 * 1024;
/// Largest distance between two positions that count as the same position.
constexpr double same_mm = 1e-6;
constexpr double beyond = 1.3;
constexpr std::size_t fewest_planned = 9;

/// Possible names of the column that contains the positions. The column of the readings has the same name as
/// in a log (log_columns.h).
constexpr std::array<std::string_view, reading_columns.size()> position_columns{"gauge_mm", "gauge_deg",
                                                                                "gauge_rad"};
constexpr std::size_t column_count = 3;
constexpr std::size_t needed_columns = 2;

/// Searches the column names of a file for a column of positions or of readings. Returns the index of this
/// column in position_columns or reading_columns, which determines the unit. Returns 0 (mm) if there is no
/// such column.
std::size_t reading_column_in(const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < reading_columns.size(); ++i) {
    const bool here = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return name == position_columns[i] || name == reading_columns[i].name;
    });
    if (here) return i;
  }
  return 0;
}

std::string header_of(model::OutputUnit output_unit) {
  const auto found = std::find_if(
      reading_columns.begin(), reading_columns.end(),
      [&](const ReadingColumn& column) { return column.unit == output_unit && column.factor == 1; });
  const auto i = static_cast<std::size_t>(found - reading_columns.begin());
  return std::string(position_columns[i]) + "," + std::string(found->name);
}

class GaugeReader {
 public:
  GaugeReader(const std::string& file, document::Problems& problems) : report_(file, problems) {}

  std::optional<GaugeFile> read(std::string_view text) {
    const std::vector<std::string_view> lines = lines_of(text);
    if (lines.empty()) {
      report_.add("file", {1, 1}, {}, "the file is empty", "the first line is gauge_mm,displacement_mm");
      return std::nullopt;
    }
    if (!read_header(lines.front())) return std::nullopt;
    for (std::size_t i = 1; i < lines.size(); ++i) read_row(lines[i], static_cast<int>(i) + 1);
    if (!report_.any()) check_positions();
    report_.finish();
    if (report_.any()) return std::nullopt;
    return GaugeFile{{}, {}, std::move(readings_), reading_->unit};
  }

 private:
  bool read_header(std::string_view line) {
    std::vector<Cell> cells;
    split(line, cells);
    count_ = cells.size();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      names.push_back(cell_text(unquoted(cells[i].text)));
    }
    const std::size_t of = reading_column_in(names);
    reading_ = &reading_columns[of];
    columns_ = {position_columns[of], reading_->name, "samples"};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto known = std::find(columns_.begin(), columns_.end(), names[i]);
      if (known == columns_.end()) continue;
      int& index = index_[static_cast<std::size_t>(known - columns_.begin())];
      if (index >= 0) report_.add("header", {1, cells[i].column}, line, "a second column '" + names[i] + "'");
      index = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < needed_columns; ++i) {
      if (index_[i] >= 0) continue;
      const std::string near = document::nearest(columns_[i], names);
      report_.add("header", {1, 1}, line, "no column '" + std::string(columns_[i]) + "'",
                  near.empty()
                      ? "the first line is " + std::string(columns_[0]) + "," + std::string(columns_[1])
                      : "is '" + document::shown(near) + "' meant?");
    }
    report_.finish();
    return !report_.any();
  }

  void read_row(std::string_view line, int number) {
    std::vector<Cell> cells;
    const bool closed = split(line, cells);
    if (cells.size() != count_ || !closed) {
      report_.add(
          "row", {number, 1}, line,
          std::to_string(cells.size()) + " cells, but the header has " + std::to_string(count_),
          cells.size() == 2 * count_ ? "if the numbers have a decimal comma, use a decimal point" : "");
      return;
    }
    std::array<double, column_count> values{0, 0, 1};
    for (std::size_t i = 0; i < column_count; ++i) {
      if (index_[i] < 0) continue;
      const auto value = number_in(cells[static_cast<std::size_t>(index_[i])], columns_[i], number, line);
      if (!value) return;
      values[i] = *value;
    }
    if (values[2] < 1) {
      report_.add("samples", {number, cells[static_cast<std::size_t>(index_[2])].column}, line,
                  "samples must be at least 1");
      return;
    }
    readings_.push_back({reading_->factor * values[0], reading_->factor * values[1], values[2]});
  }

  std::optional<double> number_in(const Cell& cell, std::string_view column, int number,
                                  std::string_view line) {
    const std::string_view text = unquoted(cell.text);
    const std::string in = " in column '" + std::string(column) + "'";
    if (text.empty()) {
      report_.add("empty cell", {number, cell.column}, line, "no number" + in,
                  "omit the row if the sensor gave no reading");
      return std::nullopt;
    }
    const auto value = to_number(text);
    if (value && std::isfinite(*value)) return value;
    report_.add("not a number", {number, cell.column}, line,
                "'" + document::shown(text, 40) + "'" + in + " is not a number",
                value ? "omit the row if the sensor gave no reading" : "");
    return std::nullopt;
  }

  void check_positions() {
    const std::size_t distinct = distinct_positions(readings_).size();
    if (distinct >= fewest_gauge_positions) return;
    report_.add("positions", {1, 1}, {},
                std::to_string(distinct) + " different positions: at least " +
                    std::to_string(fewest_gauge_positions) + " are needed",
                "two positions always fit a straight line, so they cannot show a nonlinearity");
  }

  LogReporter report_;
  const ReadingColumn* reading_ = reading_columns.data();
  std::array<std::string_view, column_count> columns_;
  std::array<int, column_count> index_{-1, -1, -1};
  std::size_t count_ = 0;
  std::vector<GaugeReading> readings_;
};

/// Returns the largest step from a list of round numbers with which at least `fewest_planned` positions lie
/// within the span.
double round_step(double span) {
  const double most = span / static_cast<double>(fewest_planned - 1);
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  double step = decade;
  for (const double round : {1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (round * decade <= most * (1 + 1e-9)) step = round * decade;
  }
  return step;
}

}  // namespace

std::optional<GaugeFile> parse_gauge(const std::string& file, std::string_view text,
                                     document::Problems& problems) {
  auto gauge = GaugeReader(file, problems).read(text);
  if (!gauge) return std::nullopt;
  gauge->path = file;
  gauge->sha256 = sha256(text);
  return gauge;
}

std::optional<GaugeFile> read_gauge(const std::string& path, document::Problems& problems) {
  const auto text = read_file(path, most_bytes);
  if (text) return parse_gauge(path, *text, problems);
  problems.add({path, {1, 1}, {}, text.error(), {}});
  return std::nullopt;
}

std::string format_gauge(const std::vector<GaugeReading>& readings, model::OutputUnit output_unit) {
  std::string text = header_of(output_unit) + ",samples\n";
  for (const GaugeReading& r : readings)
    text += shortest(r.position_mm) + "," + shortest(r.reading_mm) + "," + shortest(r.samples) + "\n";
  return text;
}

std::vector<double> distinct_positions(std::vector<double> positions_mm) {
  std::sort(positions_mm.begin(), positions_mm.end());
  const auto same = [](double a, double b) { return b - a < same_mm; };
  positions_mm.erase(std::unique(positions_mm.begin(), positions_mm.end(), same), positions_mm.end());
  return positions_mm;
}

std::vector<double> distinct_positions(const std::vector<GaugeReading>& readings) {
  std::vector<double> positions;
  positions.reserve(readings.size());
  for (const GaugeReading& r : readings) positions.push_back(r.position_mm);
  return distinct_positions(std::move(positions));
}

std::vector<double> planned_positions(double largest_reading_mm) {
  const double span = beyond * std::abs(largest_reading_mm);
  std::vector<double> up;
  if (!(span > 0) || !std::isfinite(span)) return up;
  const double step = round_step(span);
  const auto last = static_cast<int>(std::ceil(span / step - 1e-9));
  for (int i = 0; i <= last; ++i) {
    // Users read these values, so rounding errors in the last decimals are removed.
    up.push_back(std::copysign(std::round(1e6 * step * i) / 1e6, largest_reading_mm) + 0.0);
  }
  std::vector<double> all = up;
  all.insert(all.end(), up.rbegin(), up.rend());
  all.insert(all.end(), up.begin(), up.end());
  return all;
}

std::string positions_csv(const std::vector<double>& positions_mm, model::OutputUnit output_unit) {
  std::string text = header_of(output_unit) + "\n";
  for (const double position : positions_mm) text += shortest(position) + ",\n";
  return text;
}

}  // namespace softgrip::sysid
