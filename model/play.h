#pragma once
// The play operator: an output that is dragged along once its input has moved by half the play.

#include "model/number.h"
#include "model/segment.h"

namespace softgrip::model {

/// Output o with |input - o| <= reach at all times, moving only when it must. Rate independent.
template <class T>
class Play {
 public:
  explicit Play(const T& reach) : reach_(reach) {}

  /// As if the input had risen from 0.
  void reset(const T& input) { output_ = dragged(input, T(0.0)); }
  [[nodiscard]] const T& output() const { return output_; }

  /// Where the output goes for an input that moves to `end`.
  template <class U>
  [[nodiscard]] U peek(const U& end) const {
    return dragged(end, output_);
  }

  /// Passes the output on, in two segments when it begins to move inside.
  template <class Next>
  void step(const Segment<T>& in, Next&& next) {
    const T begin = output_;
    const T end = dragged(in.end, output_);
    output_ = end;
    if (same(begin, end)) {
      next(Segment<T>{in.duration_s, begin, begin, begin});
      return;
    }
    const T side = end - in.end;              // -reach on the way up, +reach on the way down
    const T gap = (begin - side) - in.begin;  // what the input moves before it drags
    const double share = value_of(gap) / value_of(T(in.end - in.begin));
    if (!(share > 1e-12) || !(share < 1.0)) {
      next(Segment<T>{in.duration_s, begin, end, in.mean + side});
      return;
    }
    const T fraction = in.fraction_at(begin - side);
    const Segment<T> moving = in.beyond(fraction);
    next(Segment<T>{in.duration_s - moving.duration_s, begin, begin, begin});
    next(Segment<T>{moving.duration_s, begin, end, moving.mean + side});
  }

 private:
  template <class U>
  [[nodiscard]] U dragged(const U& input, const T& from) const {
    if (value_of(input) - value_of(reach_) > value_of(from)) return input - reach_;
    if (value_of(input) + value_of(reach_) < value_of(from)) return input + reach_;
    return U(from);
  }

  T reach_;
  T output_{0.0};
};

}  // namespace softgrip::model
