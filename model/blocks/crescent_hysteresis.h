#pragma once
// Models a hysteresis loop that is wide at medium pressure and closes at both ends.

#include "model/block.h"
#include "model/clip.h"

namespace softgrip::model {

/// Implements a generalised play operator (Krasnosel'skii and Pokrovskii, Systems with Hysteresis, 1989,
/// chapter 2). The state c is constant while it is between two envelopes. The lower envelope moves c upwards,
/// and the upper envelope moves c downwards. With x = p/range, the upper envelope is the line x, and the
/// lower envelope is x/(1 + bend (1 - x)). For x outside [0, 1], the envelopes are equal and the block adds
/// no displacement. The mean of the envelopes is subtracted, so that the gain of the model does not change.
/// The block is rate independent.
template <class T>
class CrescentHysteresis {
 public:
  static constexpr BlockInfo info = block_info(
      "crescent_hysteresis", Station::actuator, Kind::element, Inverse::implicit, "Crescent hysteresis",
      "A hysteresis loop that is wide at medium pressure and closes at both ends.",
      "y += gain range (c - (x + l)/2); l = x/(1 + bend (1 - x)) <= c <= x = p/range");
  static constexpr std::array parameters{
      parameter("gain_mm_per_kpa", "mm/kPa", "displacement per kPa of the width of the loop", Typical{0.02},
                Within{-10.0, 10.0}, Scale{0.02}, Neutral{0.0}),
      parameter("bend", "",
                "curvature of the lower envelope; the slope of this envelope at full range is 1 + bend",
                Typical{3.0}, Within{0.0, 1000.0}, Scale{1.0}),
      parameter("range_kpa", "kPa", "pressure at which the loop closes", Typical{60.0}, Within{0.01, 10000.0},
                Scale{20.0})};

  CrescentHysteresis(std::span<const T> values, const Preparation&)
      : gain_(values[0]), bend_(values[1]), range_kpa_(values[2]) {}

  void reset(const T& input) {
    at_ = followed(T(0.0), T(input / range_kpa_));
    output_ = added(at_, T(input / range_kpa_));
  }
  [[nodiscard]] T output() const { return output_; }

  // Computes the mean of the output by Simpson's rule, for a pressure that changes linearly over the segment.
  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    const T half = (in.begin + in.end) * 0.5 / range_kpa_, end = in.end / range_kpa_;
    const T middle = added(followed(at_, half), half);
    at_ = followed(at_, end);
    output_ = added(at_, end);
    return {in.duration_s, begin, output_, (begin + middle * 4.0 + output_) * (1.0 / 6.0)};
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    const U x = end_kpa / range_kpa_;
    return added(followed(U(at_), x), x);
  }

 private:
  template <class U>
  [[nodiscard]] U lower(const U& x) const {
    if (value_of(x) <= 0.0 || value_of(x) >= 1.0) return x;
    return x / (1.0 + bend_ * (1.0 - x));
  }
  template <class U>
  [[nodiscard]] U followed(const U& at, const U& x) const {
    return lesser(greater(at, lower(x)), x);
  }
  template <class U>
  [[nodiscard]] U added(const U& at, const U& x) const {
    return gain_ * range_kpa_ * (at - (x + lower(x)) * 0.5);
  }

  T gain_;
  T bend_;
  T range_kpa_;
  T at_{0.0};  // the state c of the generalised play
  T output_{0.0};
};

}  // namespace softgrip::model
