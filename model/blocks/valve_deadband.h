#pragma once
// Models a valve that ignores small changes of the command, because its regulator has a dead band or its
// linkage has play.

#include "model/block.h"
#include "model/play.h"

namespace softgrip::model {

/// Computes the pressure from the command. After a reversal of the command, the pressure is constant until
/// the command has moved back by the width of the band. After that, the pressure follows the command.
template <class T>
class ValveDeadband : public OnePartBlock<T, Play<T>> {
 public:
  static constexpr BlockInfo info = block_info(
      "valve_deadband", Station::valve, Kind::pressure, Inverse::play, "Valve dead band",
      "After a reversal, the valve ignores changes of the commanded pressure that are smaller than a band.",
      "|u - p| <= band/2; p moves only to keep this condition");
  static constexpr std::array parameters{parameter(
      "band_kpa", "kPa", "largest change of the commanded pressure that the valve ignores after a reversal",
      Typical{1.0}, Within{0.0, 1000.0}, Scale{0.5}, Neutral{0.0})};

  ValveDeadband(std::span<const T> values, const Preparation&)
      : OnePartBlock<T, Play<T>>(Play<T>(T(values[0] * 0.5))) {}
};

}  // namespace softgrip::model
