#include "sysid/import/motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "sysid/import/role_fit.h"
#include "sysid/import/units.h"
#include "sysid/logs/sensor_codes.h"

namespace softgrip::sysid {
namespace {

/// Smallest span of a motion, relative to the largest span of a column in the same unit. A sensor axis at an
/// angle of 84 degrees to the motion measures 10 % of it.
constexpr double smallest_share = 0.1;

/// Returns the finite values of a column that are not codes for missing values.
std::vector<double> readings_of(const TableColumn& column) {
  const std::vector<double> codes = sensor_codes(column.values);
  std::vector<double> readings;
  for (const double value : column.values) {
    if (std::isfinite(value) && std::find(codes.begin(), codes.end(), value) == codes.end())
      readings.push_back(value);
  }
  return readings;
}

/// Returns the span of the readings, or 0 if the readings are only noise. The ratio of the mean square
/// difference of successive values to the variance is 2 for white noise (von Neumann, 1941) and much smaller
/// for a motion that is sampled often enough.
double span_of_motion(const std::vector<double>& readings) {
  if (readings.size() < 2) return 0;
  const double mean =
      std::accumulate(readings.begin(), readings.end(), 0.0) / static_cast<double>(readings.size());
  double square = 0;
  double difference = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    square += (readings[i] - mean) * (readings[i] - mean);
    if (i > 0) difference += (readings[i] - readings[i - 1]) * (readings[i] - readings[i - 1]);
  }
  if (difference >= square) return 0;
  const auto [low, high] = std::minmax_element(readings.begin(), readings.end());
  return *high - *low;
}

std::string unit_of(const TableColumn& column) {
  return lower_case(stated_unit(column, Quantity::displacement));
}

}  // namespace

std::vector<std::size_t> moving_columns(const ForeignTable& table, std::span<const std::size_t> columns) {
  std::vector<double> spans;
  for (const std::size_t index : columns) spans.push_back(span_of_motion(readings_of(table.columns[index])));
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    double largest = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool same = unit_of(table.columns[columns[i]]) == unit_of(table.columns[columns[k]]);
      if (same) largest = std::max(largest, spans[i]);
    }
    if (spans[k] > 0 && spans[k] >= smallest_share * largest) moving.push_back(columns[k]);
  }
  return moving;
}

}  // namespace softgrip::sysid
