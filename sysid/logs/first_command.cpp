#include "sysid/logs/first_command.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/statistics.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

/// Largest number of samples with a wrong command. With more samples, the first command counts as a pulse.
constexpr std::size_t most_wrong = limits::fewest_occurrences - 1;
/// Smallest number of samples with the next command.
constexpr std::size_t fewest_held = limits::fewest_events;

/// Returns the median of the readings from sample `first` on, under commands within 10 % of the range around
/// a command; NaN if there is none.
double usual_reading_mm(const Log& log, std::size_t first, double command_kpa, double range_kpa) {
  std::vector<double> readings;
  for (std::size_t i = first; i < log.size(); ++i) {
    if (std::isfinite(log.displacement_mm[i]) &&
        std::abs(log.pressure_command_kpa[i] - command_kpa) <= different_command_share * range_kpa)
      readings.push_back(log.displacement_mm[i]);
  }
  return readings.empty() ? std::numeric_limits<double>::quiet_NaN() : median_of(std::span(readings));
}

}  // namespace

std::optional<WrongFirstCommand> wrong_first_command(const Log& log) {
  const std::vector<double>& command = log.pressure_command_kpa;
  std::size_t samples = 1;
  while (samples < command.size() && command[samples] == command.front()) ++samples;
  if (samples > most_wrong || log.size() < samples + 2 * fewest_held) return {};
  const auto [low, high] = std::ranges::minmax(std::span(command).subspan(samples));
  const double range_kpa = high - low;
  const WrongFirstCommand found{samples, command.front(), command[samples]};
  if (!(std::abs(found.command_kpa - found.next_kpa) > different_command_share * range_kpa)) return {};
  std::size_t standing = samples;
  while (standing < log.size() &&
         std::abs(command[standing] - found.next_kpa) <= steady_drive_share * range_kpa)
    ++standing;
  if (standing < samples + fewest_held || standing == log.size()) return {};
  const std::span<const double> readings(log.displacement_mm);
  std::vector<double> first = finite_values(readings.first(samples + most_wrong)).values;
  if (first.empty()) return {};
  const double first_mm = median_of(std::span(first));
  const double under_next_mm = usual_reading_mm(log, standing, found.next_kpa, range_kpa);
  const double under_first_mm = usual_reading_mm(log, standing, found.command_kpa, range_kpa);
  if (std::isnan(under_next_mm)) return {};
  bool is_wrong = std::abs(first_mm - under_next_mm) < std::abs(first_mm - under_first_mm);
  if (std::isnan(under_first_mm)) {
    // No other sample has the first command. It is beyond all other commands, so the reading would be beyond
    // all other readings.
    const auto extent = extent_of(readings.subspan(standing));
    is_wrong = extent && extent->lowest <= first_mm && first_mm <= extent->highest;
  }
  if (!is_wrong) return {};
  return found;
}

}  // namespace softgrip::sysid
