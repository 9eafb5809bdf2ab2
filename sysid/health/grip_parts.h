#pragma once
// Divides a recorded grip into rest, free motion and holding. Free motion gives the indicators of the finger,
// and holding gives those of its pressure line. Samples that belong to none of these parts are not scored.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

enum class Part : std::uint8_t {
  neither,  ///< in contact but not held; released but not yet clear of the object; after the loss of a part
            ///< or after a fault
  rest,     ///< vented, before the first motion
  free,
  held,  ///< HOLDING, while the command is the same as at the start of HOLDING
};

struct GripParts {
  std::vector<Part> at;  ///< part of each sample
  /// Times of events [s]; NaN if the recording has no such event.
  double began_s = std::numeric_limits<double>::quiet_NaN();    ///< first step
  double contact_s = std::numeric_limits<double>::quiet_NaN();  ///< first contact
  double holding_s = std::numeric_limits<double>::quiet_NaN();  ///< first HOLDING
};

/// Assigns each sample of a channel to a part of the grip.
/// @param predicted_mm  predicted free motion of each sample.
/// @param full_kpa  full pressure of the finger, > 0. The finger is at rest until the command has risen by
/// 0.5 % of it. During HOLDING, a command change by up to 2 % of it is ignored.
[[nodiscard]] GripParts parts_of(const Recording& recording, std::size_t channel,
                                 const std::vector<double>& predicted_mm, double full_kpa);

}  // namespace softgrip::sysid::health
