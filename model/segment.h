#pragma once
// Defines the signal between two blocks during a time interval in which the signal is monotone.

#include <cmath>
#include <limits>

#include "model/dual.h"

namespace softgrip::model {

/// One interval of a signal. If `duration_s` is zero, the segment is a jump from `begin` to `end`. `mean` is
/// the average of the signal over the interval. The blocks that receive a segment treat the signal as the
/// parabola with this begin, end and mean. The parabola represents the curvature of the signal (the
/// exponential of a lag) to second order. If the signal is straight, `mean` is the average of `begin` and
/// `end`. Pressures are monotone within a segment. T is double or an automatic differentiation type.
template <class T>
struct Segment {
  T duration_s;
  T begin;
  T end;
  T mean;

  static Segment straight(const T& duration_s, const T& begin, const T& end) {
    return {duration_s, begin, end, (begin + end) * 0.5};
  }

  /// Returns the coefficient `bend` of the parabola begin + (end - begin) s + bend s (1 - s), with s in [0,
  /// 1]. The coefficient is exactly 0 for a straight signal.
  [[nodiscard]] T bend() const { return (mean - (begin + end) * 0.5) * 6.0; }

  /// Returns the value of the signal after a fraction of the duration.
  [[nodiscard]] T at(const T& fraction) const {
    return begin + (end - begin) * fraction + bend() * (fraction * (1.0 - fraction));
  }

  /// Returns the part of the segment from its start to a fraction of its duration. The fraction must be in
  /// (0, 1).
  [[nodiscard]] Segment before(const T& fraction) const {
    const T value = at(fraction);
    const T middle = at(fraction * 0.5);
    return {duration_s * fraction, begin, value, (begin + value + middle * 4.0) * (1.0 / 6.0)};
  }

  /// Returns the part of the segment from a fraction of its duration to its end. The fraction must be in (0,
  /// 1).
  [[nodiscard]] Segment beyond(const T& fraction) const {
    const T value = at(fraction);
    const T middle = at((fraction + 1.0) * 0.5);
    return {duration_s * (1.0 - fraction), value, end, (value + end + middle * 4.0) * (1.0 / 6.0)};
  }

  /// Returns the fraction of the duration after which a monotone segment crosses `level`. The level must be
  /// between begin and end (both excluded).
  [[nodiscard]] T fraction_at(const T& level) const {
    using std::sqrt;
    // Computes the root s of bend s^2 - (rise + bend) s + (level - begin) = 0, where rise = end - begin. The
    // formula has no cancellation, also for straight segments.
    const T sum = (end - begin) + bend();
    const T discriminant = sum * sum - 4.0 * bend() * (level - begin);
    if (value_of(discriminant) <= 0.0) return (level - begin) / (end - begin);
    const T root = sqrt(discriminant);
    return 2.0 * (level - begin) / (value_of(sum) < 0.0 ? sum - root : sum + root);
  }
};

/// Passes on a jump of the input (a segment without duration) for a block whose output follows the input at
/// once in some directions. `rises_at_once` and `falls_at_once` name these directions. In the other
/// directions, a jump does not change the output.
template <class T, class Next>
void pass_jump(T& output, const Segment<T>& in, bool rises_at_once, bool falls_at_once, Next&& next) {
  const bool rises = value_of(in.end) > value_of(output);
  if (!(rises ? rises_at_once : falls_at_once)) return;
  const T begin = output;
  output = in.end;
  next(Segment<T>::straight(in.duration_s, begin, output));
}

/// The surroundings of the rig during a sample. Each block uses only the members that affect it.
struct Surroundings {
  /// Time from the start of the measurement campaign to the end of the sample [s]. NaN: the chain uses the
  /// sum of its step durations since reset().
  double time_s = std::numeric_limits<double>::quiet_NaN();
  /// Time that is added to time_s in the phase of a periodic disturbance [s]. An oscillation that does not
  /// depend on the command begins each log of a campaign with another phase.
  double oscillation_shift_s = 0;
  double supply_kpa = 1e9;    ///< supply pressure; the default is so high that no block reacts to it
  double temperature_c = 20;  ///< temperature of the actuator
};

}  // namespace softgrip::model
