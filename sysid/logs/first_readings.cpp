#include "sysid/logs/first_readings.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/statistics.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/input_smoothing.h"
#include "sysid/logs/isolated_values.h"

namespace softgrip::sysid {
namespace {

/// Number of readings after the first ones, with which the first ones are compared.
constexpr std::size_t compared = limits::fewest_occurrences - 1;
/// Smallest jump that no motion explains, as a multiple of the largest step in the rest of the log.
constexpr double faster_than_the_finger = 4;

/// The beginning of a pressure column, and the range of the complete column.
struct Beginning {
  Beginning(const std::vector<double>& column, std::size_t samples)
      : kpa(std::span(column).first(std::min(samples, column.size()))), range_kpa(width_of(column)) {}

  [[nodiscard]] bool steps() const { return largest_step(kpa) > different_command_share * range_kpa; }
  [[nodiscard]] bool changes_by_more_than(double share) const { return width_of(kpa) > share * range_kpa; }

  std::span<const double> kpa;
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
  const FiniteValues readings = finite_values(log.displacement_mm);
  const std::size_t most =
      std::min(limits::fewest_events - 1, readings.values.size() / limits::fewest_events);
  const double noise_mm = std::max(white_noise_of(log.time_s, log.displacement_mm),
                                   least_noise_share * usual_span(log.displacement_mm));
  const std::span<const double> all(readings.values);
  for (std::size_t count = 1; count <= most; ++count) {
    const std::span<const double> first = all.first(count), rest = all.subspan(count);
    std::array<double, compared> next{};
    std::copy_n(rest.begin(), compared, next.begin());
    const auto [low, high] = std::ranges::minmax(next);
    const double jump_mm = jump_from(median_of(std::span<double>(next)), first);
    if (!(jump_mm > std::max(isolated_beyond * noise_mm, isolated_alone * (high - low)))) continue;
    const std::size_t samples = readings.samples[count + compared - 1] + 1;
    const Beginning command(log.pressure_command_kpa, samples), pressure(log.pressure_kpa, samples);
    if (command.steps() || pressure.steps()) continue;
    const auto [lowest, highest] = std::ranges::minmax(first);
    const auto after = rest.first(std::min(limits::fewest_events, rest.size()));
    const bool still = isolated_alone * width_of(after) < jump_mm;
    const bool alone = std::ranges::none_of(rest, [&, low_mm = lowest, high_mm = highest](double y) {
      return y > low_mm - 0.5 * jump_mm && y < high_mm + 0.5 * jump_mm;
    });
    if (jump_mm > faster_than_the_finger * largest_step(rest) ||
        (still && alone && !command.changes_by_more_than(steady_drive_share) &&
         !pressure.changes_by_more_than(different_command_share)))
      return WrongFirstReadings{count, readings.samples[count - 1] + 1, first.back(), rest.front()};
  }
  return {};
}

}  // namespace softgrip::sysid
