#pragma once
// Models a gain of the actuator that depends on the temperature of the actuator.

#include "model/block.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// Multiplies the displacement y by 1 + a (temperature - 20 degC). The parameter a is the relative change per
/// kelvin. positive_gain() limits this factor to positive values. The temperature is a member of
/// Surroundings. A log for this block needs the column temperature_c.
template <class T>
class ThermalGain : public SurroundingsGain<ThermalGain<T>, T> {
 public:
  static constexpr BlockInfo info =
      block_info("thermal_gain", Station::actuator, Kind::displacement, Inverse::implicit, "Thermal gain",
                 "The gain of the finger depends on the temperature.",
                 "z = y (1 + gain (temperature - 20 degC)), kept positive");
  static constexpr std::array parameters{
      parameter("gain_per_c", "1/degC", "relative change of the gain per degree Celsius above 20 degC",
                Typical{0.005}, Within{-0.2, 0.2}, Scale{0.002}, Neutral{0.0})};

  ThermalGain(std::span<const T> values, const Preparation&) : gain_per_c_(values[0]) {}

  [[nodiscard]] T law(const Surroundings& surroundings) const {
    return gain_per_c_ * (surroundings.temperature_c - 20.0);
  }

 private:
  T gain_per_c_;
};

}  // namespace softgrip::model
