#pragma once
// Motions that the commands of logs do not contain, so that no fit can find their effects in the readings.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Motions that a log should contain.
enum class Excitation : std::uint8_t {
  unloading,   ///< the pressure decreases by 20 % of the largest pressure
  rest,        ///< more than 3 s without pressure (at most 2 % of the largest)
  amplitudes,  ///< peaks of two heights that differ by 5 % of the largest; both exceed the next turn by 5 %
};

/// Returns the motions that no log contains. Magnitudes are used, so a vacuum rig is loaded at its lowest
/// pressure.
[[nodiscard]] std::vector<Excitation> missing_excitation(const std::vector<Log>& logs);

/// Returns a sentence about a missing motion and the effect that cannot be determined without it.
[[nodiscard]] std::string without(Excitation missing);

[[nodiscard]] bool contains_rest(const std::vector<Log>& logs);

}  // namespace softgrip::sysid
