#pragma once
// Finds motions that are missing in the commands of logs. Without such a motion, a fit cannot determine the
// corresponding effect.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Motions that a log should contain.
enum class Excitation : std::uint8_t {
  unloading,  ///< the pressure decreases by 20 % of the largest pressure
  rest,       ///< more than 3 s without pressure (at most 2 % of the largest)
  /// Two peaks whose pressures differ by 5 % of the largest; each peak is 5 % above the next turning point.
  amplitudes,
};

/// Returns the motions that no log contains. Pressures are compared by their magnitudes, so a rig with vacuum
/// has its largest load at its lowest pressure.
[[nodiscard]] std::vector<Excitation> missing_excitation(const std::vector<Log>& logs);

/// Returns a sentence about a missing motion and the effect that cannot be determined without it.
[[nodiscard]] std::string without(Excitation missing);

[[nodiscard]] bool contains_rest(const std::vector<Log>& logs);

}  // namespace softgrip::sysid
