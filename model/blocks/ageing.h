#pragma once
// Models a gain of the actuator that drifts linearly over a measurement campaign.

#include "model/block.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// Multiplies the displacement y by 1 + a t. positive_gain() limits this factor to positive values. a is the
/// relative change of the gain per time, and t is the time since the start of the measurement campaign.
template <class T>
class Ageing : public SurroundingsGain<Ageing<T>, T> {
 public:
  static constexpr BlockInfo info =
      block_info("ageing", Station::actuator, Kind::displacement, Inverse::implicit, "Ageing",
                 "The gain of the finger drifts with the time since the start of the measurements.",
                 "z = y (1 + gain t), kept positive");
  static constexpr std::array parameters{parameter("gain_per_h", "1/h",
                                                   "relative change of the gain per hour", Typical{0.1},
                                                   Within{-1000.0, 1000.0}, Scale{0.1}, Neutral{0.0})};

  Ageing(std::span<const T> values, const Preparation&) : gain_per_h_(values[0]) {}

  [[nodiscard]] T law(const Surroundings& surroundings) const {
    return gain_per_h_ * (surroundings.time_s / 3600.0);
  }

 private:
  T gain_per_h_;
};

}  // namespace softgrip::model
