#pragma once
// Models the lag of the regulator and the tube as a first-order lag with different time constants for filling
// and venting.

#include "model/block.h"
#include "model/two_way_lag.h"

namespace softgrip::model {

/// Makes the pressure follow the command with a lag. TwoWayLag (model/two_way_lag.h) describes the equation.
template <class T>
class AsymmetricValveLag : public OnePartBlock<T, TwoWayLag<T>> {
 public:
  static constexpr BlockInfo info = block_info(
      "asymmetric_valve_lag", Station::valve, Kind::pressure, Inverse::lead, "Asymmetric valve lag",
      "First-order lag of the regulator and the tube, with different time constants for filling and venting.",
      "tau p' = u - p, tau = filling where u > p, venting where u < p");
  static constexpr std::array parameters{
      parameter("filling_time_constant_s", "s", "time constant of the lag while the pressure rises",
                Typical{0.05}, Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}, Latency{}),
      parameter("venting_time_constant_s", "s", "time constant of the lag while the pressure falls",
                Typical{0.1}, Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}, Latency{})};

  AsymmetricValveLag(std::span<const T> values, const Preparation& preparation)
      : OnePartBlock<T, TwoWayLag<T>>({values[0], values[1], preparation.sample_time_s}) {}
};

}  // namespace softgrip::model
