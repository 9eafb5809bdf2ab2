#pragma once
// A steady oscillation that the command does not explain: mains hum, a pump, a swinging table.

#include <cmath>
#include <numbers>

#include "model/block.h"

namespace softgrip::model {

/// z = y + s sin(2 pi f t) + c cos(2 pi f t), t the time of the campaign. Amplitude sqrt(s^2 + c^2).
template <class T>
class PeriodicDisturbance {
 public:
  static constexpr BlockInfo info{.id = "periodic_disturbance",
                                  .station = Station::sensor,
                                  .kind = Kind::reading,
                                  .inverse = Inverse::ignored,
                                  .title = "Periodic disturbance",
                                  .meaning = "A steady oscillation that the command does not explain.",
                                  .equation = "z = y + sine sin(2 pi f t) + cosine cos(2 pi f t)",
                                  .repeatable = true};
  static constexpr std::array parameters{ParameterSpec{.name = "sine_mm",
                                                       .unit = "mm",
                                                       .default_value = 0.1,
                                                       .lower = -100.0,
                                                       .upper = 100.0,
                                                       .scale = 0.1,
                                                       .meaning = "amplitude of the sine",
                                                       .neutral = 0.0},
                                         ParameterSpec{.name = "cosine_mm",
                                                       .unit = "mm",
                                                       .default_value = 0.0,
                                                       .lower = -100.0,
                                                       .upper = 100.0,
                                                       .scale = 0.1,
                                                       .meaning = "amplitude of the cosine",
                                                       .neutral = 0.0},
                                         ParameterSpec{.name = "frequency_hz",
                                                       .unit = "Hz",
                                                       .default_value = 5.0,
                                                       .lower = 0.001,
                                                       .upper = 1000.0,
                                                       .scale = 0.01,
                                                       .meaning = "frequency"}};

  PeriodicDisturbance(std::span<const T> values, const Preparation&)
      : sine_mm_(values[0]), cosine_mm_(values[1]), omega_(values[2] * (2.0 * std::numbers::pi)) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    using std::cos;
    using std::sin;
    const T phase = omega_ * surroundings.time_s;
    return output_ = displacement_mm + sine_mm_ * sin(phase) + cosine_mm_ * cos(phase);
  }

 private:
  T sine_mm_;
  T cosine_mm_;
  T omega_;
  T output_{0.0};
};

}  // namespace softgrip::model
