#pragma once
// Models the lag of the reading behind the displacement, caused by a filter of the sensor or its amplifier.

#include "model/block.h"
#include "model/exponential.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Computes the reading z from the displacement y: tau z' = y - z with the time constant tau. The solution is
/// exact if y is a parabola over each segment.
template <class T>
class SensorLag {
 public:
  static constexpr BlockInfo info =
      block_info("sensor_lag", Station::sensor, Kind::displacement, Inverse::ignored, "Sensor lag",
                 "The reading follows the displacement with a first-order lag.", "tau z' = y - z");
  static constexpr std::array parameters{parameter("time_constant_s", "s",
                                                   "time constant of the lag of the sensor", Typical{0.02},
                                                   Within{0.0, 1e4}, Scale{0.02}, Neutral{0.0}, Latency{})};

  SensorLag(std::span<const T> values, const Preparation& preparation)
      : lag_(values[0], preparation.sample_time_s) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (lag_.passes()) {
      output_ = in.end;
      next(in);
      return;
    }
    if (is_zero(in.duration_s)) return;
    const ExponentialWeights<T>& w = lag_.at(in.duration_s);
    const T bend = in.bend();
    const T begin = output_;
    output_ = w.end(begin, in, bend);
    next(Segment<T>{in.duration_s, begin, output_, w.mean(begin, in, bend)});
  }

 private:
  LagWeights<T> lag_;
  T output_{0.0};
};

}  // namespace softgrip::model
