#pragma once
// The play operator: an output that is dragged along once its input has moved by half the play.

#include <type_traits>

#include "model/number.h"
#include "model/segment.h"

namespace softgrip::model {

/// Output o with |input - o| <= reach at all times, moving only when it must. Rate independent.
template <class T>
class Play {
 public:
  explicit Play(const T& reach) : reach_(reach) {}

  /// As if the input had risen from 0.
  void reset(const T& input) {
    output_ = T(0.0);
    settle(input);
  }
  /// The input went straight to `input`, however long ago.
  void settle(const T& input) {
    output_ = dragged(input, output_);
    dragging_ = false;
  }
  [[nodiscard]] const T& output() const { return output_; }
  /// Where the output would be if the input went straight to `input`.
  template <class U>
  [[nodiscard]] U peek(const U& input) const {
    return dragged(input, U(output_));
  }

  /// Passes the output on, in two segments when it begins to move inside.
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
    const T start = begin - side;  // the input at which it begins to move
    const double share = (value_of(start) - value_of(in.begin)) / (value_of(in.end) - value_of(in.begin));
    // A move that begins with the segment is split for the sake of derivatives alone.
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
  bool dragging_ = false;  // the last move was one of the output, not of the input alone
  bool upwards_ = false;
  T output_{0.0};
};

}  // namespace softgrip::model
