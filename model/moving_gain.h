#pragma once
// Multiplies a signal by a gain that depends on the surroundings, for example on the temperature.

#include "model/dual.h"
#include "model/segment.h"

namespace softgrip::model {

/// Returns 1 + x for x >= -1/2, and -1/(4 x) for smaller x. The result is positive and monotone in x, and its
/// value and slope are continuous. The gain is linear in x as long as it is at least 1/2.
template <class T>
[[nodiscard]] T positive_gain(const T& x) {
  return value_of(x) >= -0.5 ? T(1.0 + x) : T(-0.25 / x);
}

/// Multiplies segments by a gain that changes linearly over a sample. At the end of the sample, the gain has
/// the value that corresponds to the surroundings at this time. If a sample has several segments, the
/// complete change takes place during the first segment.
template <class T>
class MovingGain {
 public:
  void reset(const T& gain) { gain_ = gain; }

  Segment<T> step(const Segment<T>& in, const T& gain) {
    const Segment<T> out{
        in.duration_s, in.begin * gain_, in.end * gain,
        in.mean * ((gain_ + gain) * 0.5) + (in.end - in.begin) * (gain - gain_) * (1.0 / 12.0)};
    gain_ = gain;
    return out;
  }

 private:
  T gain_{1.0};
};

/// A displacement block whose gain depends only on the surroundings. `Block` declares `T law(const
/// Surroundings&) const`. The displacement is multiplied by positive_gain() of the result of law().
template <class Block, class T>
class SurroundingsGain {
 public:
  static constexpr bool at_samples = true;
  /// Sets the gain to 1. The next step sets the gain to the value that corresponds to the surroundings.
  void reset(const T& input) {
    gain_.reset(T(1.0));
    output_ = input;
  }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings& surroundings, Next&& next) {
    const Segment<T> out = gain_.step(in, at(surroundings));
    output_ = out.end;
    next(out);
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_mm, const Surroundings& surroundings) const {
    return end_mm * at(surroundings);
  }

 private:
  [[nodiscard]] T at(const Surroundings& surroundings) const {
    return positive_gain(static_cast<const Block*>(this)->law(surroundings));
  }

  MovingGain<T> gain_;
  T output_{0.0};
};

}  // namespace softgrip::model
