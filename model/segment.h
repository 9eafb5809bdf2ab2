#pragma once
// The signal between two blocks: a stretch of time over which the signal moves monotonically.

#include <cmath>
#include <limits>

#include "model/number.h"

namespace softgrip::model {

/// A stretch of a signal. `duration_s` may be zero: a jump from `begin` to `end`. `mean` is the average over
/// the stretch, so that blocks downstream see curvature (a lag's exponential) to second order: they take the
/// signal for the parabola through the three. Of a straight stretch the mean is the middle. Pressures are
/// monotone within a segment. T is double or an automatic differentiation type.
template <class T>
struct Segment {
  T duration_s;
  T begin;
  T end;
  T mean;

  static Segment straight(const T& duration_s, const T& begin, const T& end) {
    return {duration_s, begin, end, (begin + end) * 0.5};
  }

  /// How far the parabola bends: its value is begin + (end - begin) s + bend s (1 - s), s in [0, 1].
  /// Exactly 0 for a straight stretch.
  [[nodiscard]] T bend() const { return (mean - (begin + end) * 0.5) * 6.0; }

  /// The value at a fraction of the duration.
  [[nodiscard]] T at(const T& fraction) const {
    return begin + (end - begin) * fraction + bend() * (fraction * (1.0 - fraction));
  }

  /// The part from `begin` to a fraction in (0, 1).
  [[nodiscard]] Segment before(const T& fraction) const {
    const T value = at(fraction);
    const T middle = at(fraction * 0.5);
    return {duration_s * fraction, begin, value, (begin + value + middle * 4.0) * (1.0 / 6.0)};
  }

  /// The part from a fraction in (0, 1) to `end`.
  [[nodiscard]] Segment beyond(const T& fraction) const {
    const T value = at(fraction);
    const T middle = at((fraction + 1.0) * 0.5);
    return {duration_s * (1.0 - fraction), value, end, (value + end + middle * 4.0) * (1.0 / 6.0)};
  }

  /// The fraction at which a monotone segment passes `level`, which lies strictly between begin and end.
  [[nodiscard]] T fraction_at(const T& level) const {
    using std::sqrt;
    // bend s^2 - (rise + bend) s + (level - begin) = 0; the root without cancellation, straight included.
    const T sum = (end - begin) + bend();
    const T discriminant = sum * sum - 4.0 * bend() * (level - begin);
    if (value_of(discriminant) <= 0.0) return (level - begin) / (end - begin);
    const T root = sqrt(discriminant);
    return 2.0 * (level - begin) / (value_of(sum) < 0.0 ? sum - root : sum + root);
  }
};

/// What surrounds the rig while a sample passes; blocks that do not depend on it ignore it.
struct Surroundings {
  /// since the start of the campaign, at the end of the sample; NaN: the chain's own clock since reset()
  double time_s = std::numeric_limits<double>::quiet_NaN();
  double supply_kpa = 1e9;    ///< supply pressure; the default never limits
  double temperature_c = 20;  ///< of the actuator
};

}  // namespace softgrip::model
