#pragma once
// Implements a first-order lag with different time constants for filling and venting. The lag models a volume
// that air fills through a port from a high pressure, and from which air vents into a low pressure.

#include <cmath>

#include "model/dual.h"
#include "model/exponential.h"
#include "model/segment.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Computes the output p from the input u: tau p' = u - p. tau is the filling time constant if u > p, and the
/// venting time constant if u < p. The solution is exact for straight input. If the output becomes equal to
/// the input within a segment, two segments are passed on. If the filling time constant is 0, a rising output
/// follows the input immediately. If the venting time constant is 0, a falling output follows the input
/// immediately.
template <class T>
class TwoWayLag {
 public:
  TwoWayLag(const T& filling_s, const T& venting_s, double sample_time_s)
      : filling_(filling_s, sample_time_s), venting_(venting_s, sample_time_s) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] const T& output() const { return output_; }
  [[nodiscard]] const T& filling_s() const { return filling_.time_constant_s(); }
  [[nodiscard]] const T& venting_s() const { return venting_.time_constant_s(); }

  template <class Next>
  void step(const Segment<T>& in, Next&& next) {
    if (filling_.passes() && venting_.passes()) {
      output_ = in.end;
      next(in);
      return;
    }
    if (is_zero(in.duration_s)) return pass_jump(output_, in, filling_.passes(), venting_.passes(), next);
    const T gap = in.begin - output_;
    const double way = value_of(gap) != 0.0 ? value_of(gap) : value_of(in.end) - value_of(in.begin);
    LagWeights<T>& now = way >= 0.0 ? filling_ : venting_;
    LagWeights<T>& then = way >= 0.0 ? venting_ : filling_;
    const T turn_s = meeting(in, gap, now);
    const T rest_s = in.duration_s - turn_s;
    const double least_s = 1e-6 * value_of(in.duration_s);
    if (!(value_of(turn_s) > least_s && value_of(rest_s) > least_s)) {
      // If output and input become equal at a distance from an end of the segment that is below a millionth
      // of the duration, the segment is not divided.
      go(value_of(turn_s) <= least_s ? then : now, in, next);
      return;
    }
    const T fraction = turn_s / in.duration_s;
    go(now, in.before(fraction), next);
    go(then, in.beyond(fraction), next);
  }

 private:
  // Returns the time after which the output equals the input. For a straight input, the gap d = input -
  // output follows d' = slope - d / tau. The gap is zero after tau log(1 - d(0) / (slope tau)) if input and
  // output move towards each other. If input and output do not move towards each other, returns the whole
  // duration.
  T meeting(const Segment<T>& in, const T& gap, const LagWeights<T>& now) const {
    using std::log1p;
    const T slope = (in.end - in.begin) / in.duration_s;
    if (!(value_of(gap) * value_of(slope) < 0.0)) return in.duration_s;
    if (now.passes()) return T(0.0);
    const T turn_s = now.time_constant_s() * log1p(-gap / (slope * now.time_constant_s()));
    return value_of(turn_s) < value_of(in.duration_s) ? turn_s : in.duration_s;
  }

  template <class Next>
  void go(LagWeights<T>& direction, const Segment<T>& in, Next&& next) {
    const T begin = output_;
    if (direction.passes()) {
      output_ = in.end;
      next(Segment<T>{in.duration_s, begin, in.end, in.mean});
      return;
    }
    const ExponentialWeights<T>& w = direction.at(in.duration_s);
    const T bend = in.bend();
    output_ = w.end(begin, in, bend);
    next(Segment<T>{in.duration_s, begin, output_, w.mean(begin, in, bend)});
  }

  LagWeights<T> filling_, venting_;
  T output_{0.0};
};

}  // namespace softgrip::model
