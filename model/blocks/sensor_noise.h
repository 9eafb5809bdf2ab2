#pragma once
// Models the random error of the reading, as white or correlated noise.

#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "model/block.h"

namespace softgrip::model {

/// Adds Gaussian noise to the reading. With a correlation time tau above 0, two readings whose times differ
/// by dt have the correlation exp(-dt/tau) (Ornstein-Uhlenbeck process, exact for any dt). A step of zero
/// duration uses no random number.
template <class T>
class SensorNoise {
 public:
  static constexpr bool at_samples = false;
  static constexpr BlockInfo info =
      block_info("sensor_noise", Station::sensor, Kind::reading, Inverse::ignored, "Sensor noise",
                 "Random error of the reading.", "z = y + normal noise");
  static constexpr std::array parameters{
      parameter("rms_mm", "mm", "root mean square of the noise", Typical{0.05}, Within{0.0, 100.0},
                Scale{0.05}, Neutral{0.0}),
      parameter("correlation_time_s", "s",
                "correlation time of the noise; 0 for noise that is independent from reading to reading",
                Typical{0.0}, Within{0.0, 1000.0}, Scale{0.05})};

  SensorNoise(std::span<const T> values, const Preparation& preparation)
      : rms_mm_(values[0]), correlation_time_s_(value_of(values[1])), seed_(preparation.seed) {}

  void reset(const T& input) {
    drawn_ = 0;
    noise_ = 0.0;
    output_ = input;
  }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T& duration_s, const Surroundings&) {
    if (value_of(duration_s) > 0.0) draw(value_of(duration_s));
    return output_ = displacement_mm + rms_mm_ * noise_;
  }

 private:
  void draw(double duration_s) {
    const double fresh = normal_at(seed_, drawn_);
    if (drawn_++ == 0 || correlation_time_s_ <= 0.0) {
      noise_ = fresh;
      return;
    }
    const double kept = std::exp(-duration_s / correlation_time_s_);
    noise_ = kept * noise_ + std::sqrt(1.0 - kept * kept) * fresh;
  }

  T rms_mm_;
  double correlation_time_s_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  double noise_ = 0.0;  // noise, normalised to a root mean square of 1
  T output_{0.0};
};

}  // namespace softgrip::model
