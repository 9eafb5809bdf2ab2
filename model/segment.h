#pragma once
// The signal between two blocks: a time interval over which the signal is monotone.

#include <cmath>
#include <limits>

#include "model/number.h"

namespace softgrip::model {

/// One interval of a signal. A `duration_s` of zero is a jump from `begin` to `end`. `mean` is the average
/// over the interval. The next blocks treat the signal as the parabola through these three values, so that
/// they reproduce its curvature (the exponential of a lag) to second order. If the signal is straight, `mean`
/// is the average of `begin` and `end`. Pressures are monotone within a segment. T is double or an automatic
/// differentiation type.
template <class T>
struct Segment {
  T duration_s;
  T begin;
  T end;
  T mean;

  static Segment straight(const T& duration_s, const T& begin, const T& end) {
    return {duration_s, begin, end, (begin + end) * 0.5};
  }

  /// Returns the curvature: the parabola is begin + (end - begin) s + bend s (1 - s), s in [0, 1]. It is
  /// exactly 0 for a straight interval.
  [[nodiscard]] T bend() const { return (mean - (begin + end) * 0.5) * 6.0; }

  /// Returns the value at a fraction of the duration.
  [[nodiscard]] T at(const T& fraction) const {
    return begin + (end - begin) * fraction + bend() * (fraction * (1.0 - fraction));
  }

  /// Returns the part from `begin` to a fraction in (0, 1).
  [[nodiscard]] Segment before(const T& fraction) const {
    const T value = at(fraction);
    const T middle = at(fraction * 0.5);
    return {duration_s * fraction, begin, value, (begin + value + middle * 4.0) * (1.0 / 6.0)};
  }

  /// Returns the part from a fraction in (0, 1) to `end`.
  [[nodiscard]] Segment beyond(const T& fraction) const {
    const T value = at(fraction);
    const T middle = at((fraction + 1.0) * 0.5);
    return {duration_s * (1.0 - fraction), value, end, (value + end + middle * 4.0) * (1.0 / 6.0)};
  }

  /// Returns the fraction at which a monotone segment crosses `level`, which is strictly between begin and
  /// end.
  [[nodiscard]] T fraction_at(const T& level) const {
    using std::sqrt;
    // Root of bend s^2 - (rise + bend) s + (level - begin) = 0 without cancellation, also for straight
    // segments.
    const T sum = (end - begin) + bend();
    const T discriminant = sum * sum - 4.0 * bend() * (level - begin);
    if (value_of(discriminant) <= 0.0) return (level - begin) / (end - begin);
    const T root = sqrt(discriminant);
    return 2.0 * (level - begin) / (value_of(sum) < 0.0 ? sum - root : sum + root);
  }
};

/// Surroundings of the rig during a sample. Blocks that do not depend on them ignore them.
struct Surroundings {
  /// time from the start of the campaign to the end of the sample [s]; NaN: the chain uses the sum of its
  /// step durations since reset()
  double time_s = std::numeric_limits<double>::quiet_NaN();
  double supply_kpa = 1e9;    ///< supply pressure; the default has no effect
  double temperature_c = 20;  ///< temperature of the actuator
};

}  // namespace softgrip::model
