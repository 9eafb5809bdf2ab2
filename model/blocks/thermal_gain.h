#pragma once
// The gain of the actuator follows its temperature.

#include "model/block.h"
#include "model/gain.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// y times 1 + a (temperature - 20 degC), kept positive. The temperature comes with the surroundings; a log
/// needs its temperature_c column.
template <class T>
class ThermalGain {
 public:
  static constexpr BlockInfo info{.id = "thermal_gain",
                                  .station = Station::actuator,
                                  .kind = Kind::displacement,
                                  .inverse = Inverse::implicit,
                                  .title = "Thermal gain",
                                  .meaning = "The gain follows the temperature.",
                                  .equation = "z = y (1 + gain (temperature - 20 degC)), kept positive"};
  static constexpr std::array parameters{ParameterSpec{.name = "gain_per_c",
                                                       .unit = "1/degC",
                                                       .default_value = 0.005,
                                                       .lower = -0.2,
                                                       .upper = 0.2,
                                                       .scale = 0.002,
                                                       .meaning = "relative gain won per degree above 20",
                                                       .neutral = 0.0}};

  ThermalGain(std::span<const T> values, const Preparation&) : gain_per_c_(values[0]) {}

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
    return positive_gain(T(gain_per_c_ * (surroundings.temperature_c - 20.0)));
  }

  T gain_per_c_;
  MovingGain<T> gain_;
  T output_{0.0};
};

}  // namespace softgrip::model
