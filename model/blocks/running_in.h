#pragma once
// Models a gain of the actuator that drifts during the running-in period.

#include <cmath>

#include "model/block.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// Multiplies the displacement y by 1 + r (1 - exp(-t/tau)). positive_gain() limits this factor to positive
/// values. r is the final relative change of the gain of the finger, t is the time since the start of the
/// measurement campaign, and tau the time constant of the running-in.
template <class T>
class RunningIn : public SurroundingsGain<RunningIn<T>, T> {
 public:
  static constexpr BlockInfo info =
      block_info("running_in", Station::actuator, Kind::displacement, Inverse::implicit, "Running in",
                 "The gain of the finger drifts while the actuator runs in.",
                 "z = y (1 + run_in (1 - exp(-t/tau))), kept positive");
  static constexpr std::array parameters{
      parameter("run_in", "", "final relative change of the gain of the finger", Typical{0.05},
                Within{-10.0, 10.0}, Scale{0.05}, Neutral{0.0}),
      parameter("run_in_time_s", "s", "time constant of the running-in", Typical{60.0}, Within{0.1, 1e5},
                Scale{30.0}, IfLeftOut{60.0})};

  RunningIn(std::span<const T> values, const Preparation&) : run_in_(values[0]), per_s_(1.0 / values[1]) {}

  [[nodiscard]] T law(const Surroundings& surroundings) const {
    using std::expm1;
    return -run_in_ * expm1(T(per_s_ * -surroundings.time_s));
  }

 private:
  T run_in_;
  T per_s_;  // 1 divided by the time constant tau
};

}  // namespace softgrip::model
