#include "sysid/logs/command_before.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

/// A previous command is assumed only if the measured pressure, while the first command is held, covers more
/// than this share of the difference between the first command and the initial pressure. A working regulator
/// covers a larger share.
constexpr double on_its_way = 0.5;

/// Returns the number of samples at the beginning of the log whose commands differ from the first command by
/// less than 5 % of the range of the commands. A single sample with another command does not end this part of
/// the log, because a finger hardly moves within one sampling interval.
std::size_t stands_for(const Log& log, double range_kpa) {
  const std::vector<double>& command = log.pressure_command_kpa;
  const auto stands = [&](std::size_t i) {
    return i < log.size() &&
           std::abs(command[i] - command.front()) < 0.5 * different_command_share * range_kpa;
  };
  std::size_t count = 1;
  while (stands(count) || stands(count + 1)) ++count;
  return count;
}

/// A previous command is assumed only if the displacement moves by more than this share of its range while
/// the first command is held. Creep at constant pressure is smaller than this share.
constexpr double step_share = 0.2;
/// Number of readings in each of two groups whose medians are compared: the first and the last readings while
/// the first command is held. A median is insensitive to an outlier.
constexpr std::size_t at_an_end = 5;
constexpr std::size_t fewest_standing = 4 * at_an_end;

/// Returns the median of the readings in [first, last); NaN if this range contains no reading.
double median_mm(const Log& log, std::size_t first, std::size_t last) {
  std::vector<double> readings =
      finite_values(std::span(log.displacement_mm).subspan(first, last - first)).values;
  return readings.empty() ? std::numeric_limits<double>::quiet_NaN() : median_of(std::span(readings));
}

/// Returns the range of the medians of groups of successive readings [mm]. A single outlier does not change
/// this range by more than the noise. Returns 0 if there are fewer than two groups.
double range_of_medians_mm(const Log& log) {
  std::vector<double> medians;
  std::vector<double> group;
  for (const double reading : finite_values(log.displacement_mm).values) {
    group.push_back(reading);
    if (group.size() < at_an_end) continue;
    medians.push_back(median_of(std::span(group)));
    group.clear();
  }
  return width_of(medians);
}

/// Returns the command of the log that is nearest to a pressure. If the pressure is outside the range of the
/// commands, the function returns the pressure.
double command_near(double pressure_kpa, const std::vector<double>& commands, double least_kpa,
                    double most_kpa) {
  if (pressure_kpa < least_kpa || pressure_kpa > most_kpa) return pressure_kpa;
  return *std::min_element(commands.begin(), commands.end(), [pressure_kpa](double a, double b) {
    return std::abs(a - pressure_kpa) < std::abs(b - pressure_kpa);
  });
}

std::optional<double> by_pressure(const Log& log, double least_kpa, double most_kpa) {
  const double range_kpa = most_kpa - least_kpa;
  const double before_kpa = log.pressure_kpa.front();
  const double way_kpa = log.pressure_command_kpa.front() - before_kpa;
  if (!(std::abs(way_kpa) > different_command_share * range_kpa)) return {};
  for (std::size_t i = 1; i < stands_for(log, range_kpa); ++i) {
    if ((log.pressure_kpa[i] - before_kpa) / way_kpa > on_its_way)
      return command_near(before_kpa, log.pressure_command_kpa, least_kpa, most_kpa);
  }
  return {};
}

std::optional<double> by_displacement(const Log& log, double least_kpa, double most_kpa) {
  const double range_kpa = most_kpa - least_kpa;
  const std::size_t standing = stands_for(log, range_kpa);
  if (standing < fewest_standing || standing == log.size()) return {};
  const double motion_mm = median_mm(log, standing - at_an_end, standing) - median_mm(log, 0, at_an_end);
  if (!(std::abs(motion_mm) > step_share * range_of_medians_mm(log))) return {};
  const double before_kpa = motion_mm > 0 ? least_kpa : most_kpa;
  if (!(std::abs(log.pressure_command_kpa.front() - before_kpa) > different_command_share * range_kpa))
    return {};
  return before_kpa;
}

}  // namespace

std::optional<double> pressure_before_kpa(const Log& log) {
  if (log.size() < 2) return {};
  const CommandRange range = command_range(log.pressure_command_kpa);
  if (log.pressure_kpa.empty()) return by_displacement(log, range.lowest_kpa, range.highest_kpa);
  return by_pressure(log, range.lowest_kpa, range.highest_kpa);
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
  longer.notes.push_back(
      {0, "the log begins when the command changes from " + significant(before_kpa, 3) + " to " +
              significant(log.pressure_command_kpa.front(), 3) +
              " kPa, so a sample with the command before this change was added at the start of the log"});
  return longer;
}

void begin_before_first_command(std::vector<Log>& logs, bool measured_stay) {
  for (Log& log : logs) {
    if (measured_stay && !log.pressure_kpa.empty()) continue;
    if (const auto before_kpa = pressure_before_kpa(log)) log = with_command_before(log, *before_kpa);
  }
}

}  // namespace softgrip::sysid
