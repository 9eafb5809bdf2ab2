#pragma once
// Implements the play operator. The output moves with the input only while the gap between input and output
// is closed. In the middle position, the gap on each side is half of the play.

#include <type_traits>

#include "model/dual.h"
#include "model/segment.h"

namespace softgrip::model {

/// Keeps the output o within |input - o| <= reach. The output moves only as far as this condition requires.
/// The operator is rate independent.
template <class T>
class Play {
 public:
  explicit Play(const T& reach) : reach_(reach) {}

  /// Sets the state that results if the output is 0 and the input changes from 0 to `input`.
  void reset(const T& input) {
    output_ = T(0.0);
    settle(input);
  }
  /// Changes the input from its last value to `input` without reversals. The result does not depend on the
  /// duration of this change.
  void settle(const T& input) {
    output_ = dragged(input, output_);
    dragging_ = false;
  }
  [[nodiscard]] const T& output() const { return output_; }
  /// Returns the output that would result if the input changed to `input` without reversals.
  template <class U>
  [[nodiscard]] U peek(const U& input) const {
    return dragged(input, U(output_));
  }

  /// Computes the output over a segment of the input and passes the output on. If the output begins to move
  /// within the segment, the segment is divided at this point.
  template <class Next>
  void step(const Segment<T>& in, Next&& next) {
    const T begin = output_;
    const T end = dragged(in.end, output_);
    output_ = end;
    if (same(begin, end)) {
      if (!same(in.begin, in.end)) dragging_ = false;
      next(Segment<T>{in.duration_s, begin, begin, begin});
      return;
    }
    const bool upwards = value_of(end) > value_of(begin);
    const bool went_on = dragging_ && upwards == upwards_;
    dragging_ = true;
    upwards_ = upwards;
    const T side = upwards ? T(-reach_) : reach_;
    const T start = begin - side;  // input at which the output begins to move
    const double share = (value_of(start) - value_of(in.begin)) / (value_of(in.end) - value_of(in.begin));
    // If the motion of the output begins exactly at the start of the segment, the segment is divided only for
    // number types with derivatives.
    const double least = std::is_arithmetic_v<T> ? 1e-12 : -1e-12;
    if (went_on || !(share > least && share < 1.0)) {
      next(Segment<T>{in.duration_s, begin, end, in.mean + side});
      return;
    }
    const Segment<T> moving = in.beyond(in.fraction_at(start));
    next(Segment<T>{in.duration_s - moving.duration_s, begin, begin, begin});
    next(Segment<T>{moving.duration_s, begin, end, moving.mean + side});
  }

 private:
  template <class U>
  [[nodiscard]] U dragged(const U& input, const U& from) const {
    if (value_of(input) - value_of(reach_) > value_of(from)) return U(input - reach_);
    if (value_of(input) + value_of(reach_) < value_of(from)) return U(input + reach_);
    return from;
  }

  T reach_;
  bool dragging_ = false;  // true: the last change of the input also moved the output
  bool upwards_ = false;
  T output_{0.0};
};

}  // namespace softgrip::model
