#include "sysid/logs/first_readings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include "base/statistics.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/input_smoothing.h"
#include "sysid/logs/isolated_values.h"

namespace softgrip::sysid {
namespace {

/// Number of readings after the first ones, with which the first ones are compared.
constexpr std::size_t compared = limits::fewest_occurrences - 1;
/// Smallest jump that no motion explains, as a multiple of the largest step in the rest of the log.
constexpr double faster_than_the_finger = 4;

/// The readings of a log, with the index of the sample of each reading.
struct Readings {
  std::vector<std::size_t> sample;
  std::vector<double> mm;
};

Readings readings_of(const Log& log) {
  Readings readings;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (!std::isfinite(log.displacement_mm[i])) continue;
    readings.sample.push_back(i);
    readings.mm.push_back(log.displacement_mm[i]);
  }
  return readings;
}

double largest_step(std::span<const double> readings) {
  double largest = 0;
  for (std::size_t i = 1; i < readings.size(); ++i)
    largest = std::max(largest, std::abs(readings[i] - readings[i - 1]));
  return largest;
}

std::vector<double> finite(std::span<const double> values) {
  std::vector<double> found;
  std::ranges::copy_if(values, std::back_inserter(found), [](double value) { return std::isfinite(value); });
  return found;
}

double width(const std::vector<double>& values) {
  return values.empty() ? 0 : std::ranges::max(values) - std::ranges::min(values);
}

/// The beginning of a pressure column, and the range of the complete column.
struct Beginning {
  Beginning(const std::vector<double>& column, std::size_t samples)
      : kpa(finite(std::span(column).first(std::min(samples, column.size())))),
        range_kpa(width(finite(column))) {}

  [[nodiscard]] bool steps() const { return largest_step(kpa) > different_command_share * range_kpa; }
  [[nodiscard]] bool changes_by_more_than(double share) const { return width(kpa) > share * range_kpa; }

  std::vector<double> kpa;
  double range_kpa = 0;
};

/// Returns the jump from the first readings to a value (smallest distance); 0 if they are on both sides of
/// it.
double jump_from(double middle, std::span<const double> first) {
  const auto [low, high] = std::ranges::minmax(first);
  return std::max({0.0, low - middle, middle - high});
}

}  // namespace

std::optional<WrongFirstReadings> wrong_first_readings(const Log& log) {
  const Readings readings = readings_of(log);
  const std::size_t most = std::min(limits::fewest_events - 1, readings.mm.size() / limits::fewest_events);
  const double noise_mm = std::max(white_noise_of(log.time_s, log.displacement_mm),
                                   least_noise_share * usual_span(log.displacement_mm));
  const std::span<const double> all(readings.mm);
  for (std::size_t count = 1; count <= most; ++count) {
    const std::span<const double> first = all.first(count), rest = all.subspan(count);
    std::array<double, compared> next{};
    std::copy_n(rest.begin(), compared, next.begin());
    const auto [low, high] = std::ranges::minmax(next);
    const double jump_mm = jump_from(median_of(std::span<double>(next)), first);
    if (!(jump_mm > std::max(isolated_beyond * noise_mm, isolated_alone * (high - low)))) continue;
    const std::size_t samples = readings.sample[count + compared - 1] + 1;
    const Beginning command(log.pressure_command_kpa, samples), pressure(log.pressure_kpa, samples);
    if (command.steps() || pressure.steps()) continue;
    const auto [lowest, highest] = std::ranges::minmax(first);
    const std::vector<double> after = finite(rest.first(std::min(limits::fewest_events, rest.size())));
    const bool still = isolated_alone * width(after) < jump_mm;
    const bool alone = std::ranges::none_of(rest, [&, low_mm = lowest, high_mm = highest](double y) {
      return y > low_mm - 0.5 * jump_mm && y < high_mm + 0.5 * jump_mm;
    });
    if (jump_mm > faster_than_the_finger * largest_step(rest) ||
        (still && alone && !command.changes_by_more_than(steady_drive_share) &&
         !pressure.changes_by_more_than(different_command_share)))
      return WrongFirstReadings{count, readings.sample[count - 1] + 1, first.back(), rest.front()};
  }
  return {};
}

}  // namespace softgrip::sysid
