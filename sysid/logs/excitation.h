#pragma once
// Motions that the commands of logs do not contain, so that no fit can find their effects in the readings.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Motions that a log should contain.
enum class Excitation : std::uint8_t {
  unloading,   ///< the pressure falls back by a fifth of the largest one
  rest,        ///< more than 3 s at no pressure (2 % of the largest)
  amplitudes,  ///< peaks of two heights; both 5 % of the largest apart and above the next turn
};

/// Motions that no log contains. Sizes count, so a vacuum rig is loaded towards its lowest pressure.
[[nodiscard]] std::vector<Excitation> missing_excitation(const std::vector<Log>& logs);

/// "unloading never seen: hysteresis cannot be judged"
[[nodiscard]] std::string without(Excitation missing);

[[nodiscard]] bool contains_rest(const std::vector<Log>& logs);

}  // namespace softgrip::sysid
