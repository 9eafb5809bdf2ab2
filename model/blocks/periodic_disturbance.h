#pragma once
// Models a steady oscillation that does not depend on the command: mains hum, a pump, a vibrating table.

#include <cmath>
#include <numbers>

#include "model/block.h"

namespace softgrip::model {

/// Computes the reading z = y + s sin(2 pi f t) + c cos(2 pi f t) from the displacement y. The parameters are
/// s, c and the frequency f. t is the time since the start of the measurement campaign, plus the shift of the
/// log (Surroundings::oscillation_shift_s). The amplitude is sqrt(s^2 + c^2).
template <class T>
class PeriodicDisturbance {
 public:
  static constexpr BlockInfo info = block_info(
      "periodic_disturbance", Station::sensor, Kind::reading, Inverse::ignored, "Periodic disturbance",
      "Oscillation of the reading with constant amplitude, independent of the commanded pressure.",
      "z = y + sine sin(2 pi f t) + cosine cos(2 pi f t)", Repeatable{});
  static constexpr std::array parameters{
      parameter("sine_mm", "mm", "amplitude of the sine component", Typical{0.1}, Within{-100.0, 100.0},
                Scale{0.1}, Neutral{0.0}),
      parameter("cosine_mm", "mm", "amplitude of the cosine component", Typical{0.0}, Within{-100.0, 100.0},
                Scale{0.1}, Neutral{0.0}),
      parameter("frequency_hz", "Hz", "frequency of the oscillation", Typical{5.0}, Within{0.001, 1000.0},
                Scale{0.01})};

  PeriodicDisturbance(std::span<const T> values, const Preparation&)
      : sine_mm_(values[0]), cosine_mm_(values[1]), omega_(values[2] * (2.0 * std::numbers::pi)) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings& surroundings) {
    using std::cos;
    using std::sin;
    const T phase = omega_ * (surroundings.time_s + surroundings.oscillation_shift_s);
    return output_ = displacement_mm + sine_mm_ * sin(phase) + cosine_mm_ * cos(phase);
  }

 private:
  T sine_mm_;
  T cosine_mm_;
  T omega_;
  T output_{0.0};
};

}  // namespace softgrip::model
