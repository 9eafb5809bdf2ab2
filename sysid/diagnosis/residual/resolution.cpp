#include "sysid/diagnosis/residual/resolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/statistics.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Smallest step of a coarse sensor, as a share of the span of the readings. Usual converters and the numbers
/// in files have finer steps.
constexpr double coarse_share = 1e-3;

/// Largest distance of a difference from a multiple of the step, as a share of the step.
constexpr double off_multiple = 0.1;
/// Differences of more steps are not tested, because the step is not known accurately enough.
constexpr double most_steps = 3;

/// Number of readings before and after a third difference in which the motion must be slow.
constexpr std::size_t beside = 6;

/// Returns the sizes of all differences of consecutive readings that are not equal [mm].
std::vector<double> changes_mm(const std::vector<Record>& records) {
  std::vector<double> changes;
  for (const Record& record : records) {
    for (std::size_t i = 1; i < record.size(); ++i) {
      const double change = std::abs(record.reading_mm[i] - record.reading_mm[i - 1]);
      // A difference by the rounding of binary numbers is not a change.
      if (std::isfinite(change) && change > 1e-9 * std::abs(record.reading_mm[i])) changes.push_back(change);
    }
  }
  return changes;
}

/// Returns the step of which nearly all small differences are multiples [mm], or 0.
double common_step_mm(const std::vector<double>& changes) {
  if (changes.size() < limits::fewest_events) return 0;
  const double smallest = *std::ranges::min_element(changes);
  double sum = 0, steps = 0;
  std::size_t tested = 0, fitting = 0;
  for (const double change : changes) {
    const double multiple = std::round(change / smallest);
    if (multiple > most_steps) continue;
    ++tested;
    if (std::abs(change - multiple * smallest) > off_multiple * smallest) continue;
    ++fitting;
    sum += change;
    steps += multiple;
  }
  const bool is_common = static_cast<double>(fitting) > limits::probability * static_cast<double>(tested);
  return is_common && fitting >= limits::fewest_events ? sum / steps : 0;
}

/// Returns the variance of the white noise during slow motion [mm^2]. NaN: there are too few readings during
/// slow motion.
double white_in_slow_motion_mm2(const std::vector<Record>& records, double step_mm) {
  // Readings of two adjacent steps have third differences of at most 4 steps.
  const double largest = 4.5 * step_mm, slow = 1.5 * step_mm;
  double squares = 0;
  std::size_t count = 0;
  for (const Record& record : records) {
    const std::vector<double>& y = record.reading_mm;
    for (std::size_t i = 3 + beside; i + beside < y.size(); ++i) {
      const double third = y[i] - 3 * y[i - 1] + 3 * y[i - 2] - y[i - 3];
      if (!(std::abs(third) < largest && std::abs(y[i + beside] - y[i - 3 - beside]) < slow)) continue;
      squares += third * third;
      ++count;
    }
  }
  constexpr double inflation = 20;  // variance of the third difference of white noise with the variance 1
  return count < limits::fewest_readings ? std::nan("") : squares / (inflation * static_cast<double>(count));
}

/// Returns the variance of the error by rounding that is not white noise during slow motion [mm^2].
double slow_variance_mm2(double step_mm, double noise_mm) {
  double sum = 0;
  for (int k = 1; k <= 1000; ++k) {
    const double decay = square(2 * std::numbers::pi * k * noise_mm / step_mm);
    const double term = std::exp(-decay) / (2 * square(std::numbers::pi * k));
    sum += term;
    if (term < 1e-6 * sum) break;
  }
  return step_mm * step_mm * sum;
}

}  // namespace

double noise_before_rounding_mm(const std::vector<Record>& records, double step_mm, double white_mm) {
  const double slow_mm2 = white_in_slow_motion_mm2(records, step_mm);
  const double rounding_mm2 = rounding_variance_mm2(step_mm);
  if (!std::isfinite(slow_mm2)) return std::sqrt(std::max(0.0, white_mm * white_mm - rounding_mm2));
  const auto white_mm2 = [&](double noise_mm) {
    return noise_mm * noise_mm + rounding_mm2 - slow_variance_mm2(step_mm, noise_mm);
  };
  // The white noise increases with the noise before rounding.
  double low = 0, high = step_mm;
  while (white_mm2(high) < slow_mm2) high *= 2;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = (low + high) / 2;
    (white_mm2(middle) < slow_mm2 ? low : high) = middle;
  }
  return low;
}

double coarse_step_mm(const std::vector<Record>& records) {
  const double step_mm = common_step_mm(changes_mm(records));
  if (step_mm < coarse_share * campaign_size(records).span_mm) return 0;
  const double noise_mm = noise_before_rounding_mm(records, step_mm, white_noise_mm(records));
  return noise_mm * noise_mm <= rounding_variance_mm2(step_mm) ? step_mm : 0;
}

}  // namespace softgrip::sysid
