#pragma once
// Models the pressure in the chamber of the finger, which follows the pressure at the pressure sensor with a
// first-order lag.

#include "model/block.h"
#include "model/two_way_lag.h"

namespace softgrip::model {

/// Makes the pressure in the chamber follow the pressure at the sensor with a lag. TwoWayLag
/// (model/two_way_lag.h) describes the equation.
template <class T>
class ChamberLag : public OnePartBlock<T, TwoWayLag<T>> {
 public:
  static constexpr BlockInfo info =
      block_info("chamber_lag", Station::valve, Kind::pressure, Inverse::lead, "Chamber lag",
                 "First-order lag between the pressure sensor and the chamber of the finger.",
                 "tau p' = q - p, tau = filling where q > p, venting where q < p");
  static constexpr std::array parameters{
      parameter("filling_time_constant_s", "s", "time constant of the lag while the pressure rises",
                Typical{0.1}, Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}, Latency{}),
      parameter("venting_time_constant_s", "s", "time constant of the lag while the pressure falls",
                Typical{0.2}, Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}, Latency{})};

  ChamberLag(std::span<const T> values, const Preparation& preparation)
      : OnePartBlock<T, TwoWayLag<T>>({values[0], values[1], preparation.sample_time_s}) {}
};

}  // namespace softgrip::model
