#pragma once
// Divides a recorded grip into rest, free motion and holding. The indicators of the finger are computed from
// the free motion. The indicators of its pressure line are computed from the time in which the part is held.
// All other samples are not scored.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

enum class Part : std::uint8_t {
  /// Neither rest, free motion nor HOLDING; for example in contact before HOLDING, or after a fault.
  neither,
  rest,  ///< samples of a vented finger before its first motion
  free,
  held,  ///< HOLDING with the command that was active at the start of HOLDING
};

struct GripParts {
  std::vector<Part> at;  ///< part of the grip to which each sample belongs
  /// Times of events [s]; NaN if the recording has no such event.
  double began_s = std::numeric_limits<double>::quiet_NaN();    ///< time of the first step
  double contact_s = std::numeric_limits<double>::quiet_NaN();  ///< time of the first contact
  double holding_s = std::numeric_limits<double>::quiet_NaN();  ///< time of the first HOLDING
};

/// Assigns each sample of a channel to a part of the grip.
/// @param predicted_mm  predicted free motion of each sample.
/// @param full_kpa  full pressure of the finger, > 0. The finger is at rest until the command has risen by
/// 0.5 % of `full_kpa`. During HOLDING, a command change by up to 2 % of `full_kpa` is ignored.
[[nodiscard]] GripParts parts_of(const Recording& recording, std::size_t channel,
                                 const std::vector<double>& predicted_mm, double full_kpa);

}  // namespace softgrip::sysid::health
