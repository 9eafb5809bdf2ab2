#include "sysid/changes/orientation.h"

#include <algorithm>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

void mirror(std::vector<double>& column, double factor) {
  for (double& value : column) value *= factor;
}

/// Returns the correlation of the readings with the commands. The mean command and the mean reading of each
/// log are subtracted, because runs differ in their zero.
double correlation_within(const std::vector<Log>& logs) {
  PairSums pooled;
  for (const Log& log : logs) {
    PairSums sums;
    for (std::size_t i = 0; i < log.size(); ++i)
      sums.add(log.pressure_command_kpa[i], log.displacement_mm[i]);
    for (std::size_t i = 0; i < log.size(); ++i)
      pooled.add(log.pressure_command_kpa[i] - sums.x / sums.count,
                 log.displacement_mm[i] - sums.y / sums.count);
  }
  return pooled.correlation();
}

}  // namespace

Orientation orientation_of(const std::vector<Log>& logs) {
  double lowest_kpa = 0, highest_kpa = 0;
  for (const Log& log : logs) {
    for (const double kpa : log.pressure_command_kpa) {
      lowest_kpa = std::min(lowest_kpa, kpa);
      highest_kpa = std::max(highest_kpa, kpa);
    }
  }
  Orientation orientation;
  orientation.pressure = -lowest_kpa > highest_kpa ? -1 : 1;
  orientation.reading = correlation_within(logs) * orientation.pressure < -limits::clear_correlation ? -1 : 1;
  return orientation;
}

std::vector<Log> oriented(std::vector<Log> logs, const Orientation& orientation) {
  for (Log& log : logs) {
    mirror(log.pressure_command_kpa, orientation.pressure);
    mirror(log.pressure_kpa, orientation.pressure);
    mirror(log.displacement_mm, orientation.reading);
  }
  return logs;
}

std::string sentence_of(const Orientation& orientation) {
  if (!orientation.is_mirrored()) return {};
  const std::string columns = orientation.pressure > 0  ? "the readings"
                              : orientation.reading > 0 ? "the pressures"
                                                        : "the pressures and the readings";
  return "The causes act on positive pressures and on readings that rise with the pressure, so " + columns +
         " are multiplied by -1 for this diagnosis. All sizes, positions and charts refer to the multiplied "
         "values, and the given model is not used";
}

}  // namespace softgrip::sysid
