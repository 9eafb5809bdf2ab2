#include "sysid/logs/command_before.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

/// Of the command's range: a regulator's error and the pressure sensor's are below it.
constexpr double far = 0.1;
/// Of the way to the command; a regulator's own lag comes farther within any hold.
constexpr double on_its_way = 0.5;

/// Samples from the first on at which the command is still what it was.
std::size_t stands_for(const Log& log, double range_kpa) {
  const std::vector<double>& command = log.pressure_command_kpa;
  std::size_t count = 1;
  while (count < log.size() && std::abs(command[count] - command.front()) < 0.5 * far * range_kpa) ++count;
  return count;
}

}  // namespace

std::optional<double> pressure_before_kpa(const Log& log) {
  if (log.pressure_kpa.empty() || log.size() < 2 || !std::isfinite(log.pressure_kpa.front())) return {};
  const auto [least, most] =
      std::minmax_element(log.pressure_command_kpa.begin(), log.pressure_command_kpa.end());
  const double range_kpa = *most - *least;
  const double before_kpa = log.pressure_kpa.front();
  const double way_kpa = log.pressure_command_kpa.front() - before_kpa;
  if (!(std::abs(way_kpa) > far * range_kpa)) return {};
  for (std::size_t i = 1; i < stands_for(log, range_kpa); ++i) {
    if ((log.pressure_kpa[i] - before_kpa) / way_kpa > on_its_way) return before_kpa;
  }
  return {};
}

Log with_command_before(const Log& log, double before_kpa) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double interval_s = log.size() > 1 ? sampling_of(log).median_interval_s : 0;
  Log longer = log;
  const auto put_first = [](std::vector<double>& column, double value) {
    if (!column.empty()) column.insert(column.begin(), value);
  };
  for (double& time_s : longer.time_s) time_s += interval_s;
  put_first(longer.time_s, log.time_s.front());
  put_first(longer.pressure_command_kpa, before_kpa);
  put_first(longer.displacement_mm, none);
  put_first(longer.pressure_kpa, none);
  for (auto* column : {&longer.temperature_c, &longer.supply_kpa}) {
    if (!column->empty()) put_first(*column, column->front());
  }
  for (OtherColumn& other : longer.others) other.cells.insert(other.cells.begin(), std::string());
  longer.notes.push_back({0, "it begins as its command was set, from " + significant(before_kpa, 3) + " to " +
                                 significant(log.pressure_command_kpa.front(), 3) +
                                 " kPa: a sample before it says so"});
  return longer;
}

}  // namespace softgrip::sysid
