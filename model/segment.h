#pragma once
// The signal between two blocks: a stretch of time over which the signal moves monotonically.

#include <cmath>

namespace softgrip::model {

/// A monotone stretch of a signal. `duration_s` may be zero: a jump from `begin` to `end`. `mean` is the
/// average over the stretch, so that linear blocks downstream see curvature (a lag's exponential) to second
/// order exactly; of a straight stretch it is the middle. T is double or an automatic differentiation type.
template <class T>
struct Segment {
  T duration_s;
  T begin;
  T end;
  T mean;

  static Segment straight(T duration_s, T begin, T end) {
    return {duration_s, begin, end, (begin + end) * 0.5};
  }
};

/// What surrounds the rig while a sample passes; blocks that do not depend on it ignore it.
struct Surroundings {
  double time_s = 0;          ///< since the start of the campaign, at the end of the sample
  double supply_kpa = 1e9;    ///< supply pressure; the default never limits
  double temperature_c = 20;  ///< of the actuator
};

}  // namespace softgrip::model
