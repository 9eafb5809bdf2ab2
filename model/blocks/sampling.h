#pragma once
// Models a sensor whose sampling rate is lower than that of the log.

#include <cmath>

#include "model/block.h"

namespace softgrip::model {

/// Returns the reading at the last multiple of the sampling interval, with the derivatives of this reading.
template <class T>
class Sampling {
 public:
  static constexpr BlockInfo info = block_info(
      "sampling", Station::sensor, Kind::reading, Inverse::ignored, "Sampling",
      "The interval between two updates of the sensor reading is longer than the sample interval of the log.",
      "z(t) = y(interval floor(t/interval))");
  static constexpr std::array parameters{parameter("interval_s", "s",
                                                   "time between two updates of the reading", Typical{0.1},
                                                   Within{0.0, 100.0}, Scale{0.05}, Neutral{0.0})};

  Sampling(std::span<const T> values, const Preparation&) : interval_s_(value_of(values[0])) {}

  void reset(const T& input) {
    output_ = input;
    since_s_ = 0;
  }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T& duration_s, const Surroundings&) {
    constexpr double rounding_s = 1e-9;
    since_s_ += value_of(duration_s);
    if (since_s_ + rounding_s < interval_s_) return output_;
    since_s_ = interval_s_ > 0 ? std::fmod(since_s_ + rounding_s, interval_s_) : 0;
    return output_ = displacement_mm;
  }

 private:
  double interval_s_;
  double since_s_ = 0;
  T output_{0.0};
};

}  // namespace softgrip::model
