#pragma once
// The gain of the actuator drifts across a campaign.

#include "model/block.h"
#include "model/gain.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// y times 1 + a t, t the time of the campaign, kept positive.
template <class T>
class Ageing {
 public:
  static constexpr BlockInfo info{.id = "ageing",
                                  .station = Station::actuator,
                                  .kind = Kind::displacement,
                                  .inverse = Inverse::implicit,
                                  .title = "Ageing",
                                  .meaning = "The gain drifts with the time of the campaign.",
                                  .equation = "z = y (1 + gain t), kept positive"};
  static constexpr std::array parameters{ParameterSpec{.name = "gain_per_h",
                                                       .unit = "1/h",
                                                       .default_value = 0.1,
                                                       .lower = -1000.0,
                                                       .upper = 1000.0,
                                                       .scale = 0.1,
                                                       .meaning = "relative gain won per hour",
                                                       .neutral = 0.0}};

  Ageing(std::span<const T> values, const Preparation&) : gain_per_h_(values[0]) {}

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
    return positive_gain(T(gain_per_h_ * (surroundings.time_s / 3600.0)));
  }

  T gain_per_h_;
  MovingGain<T> gain_;
  T output_{0.0};
};

}  // namespace softgrip::model
