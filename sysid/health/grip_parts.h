#pragma once
// A recorded grip, divided: at rest, in free motion, held. The numbers of a finger come from free motion,
// those of its line from the held part; nothing is scored where neither is known.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

enum class Part : std::uint8_t {
  neither,  ///< touching but not held, let go but not yet away from the object, after a part was lost or a
            ///< fault
  rest,     ///< vented, before the first motion
  free,
  held,  ///< HOLDING, the command as it was when it became so
};

struct GripParts {
  std::vector<Part> at;  ///< sample by sample
  /// NaN where the recording does not say it.
  double began_s = std::numeric_limits<double>::quiet_NaN();    ///< first step
  double contact_s = std::numeric_limits<double>::quiet_NaN();  ///< first touch
  double holding_s = std::numeric_limits<double>::quiet_NaN();  ///< first HOLDING
};

/// @param predicted_mm  what the free finger would do, sample by sample.
/// @param full_kpa  of the finger, > 0: a hundredth of it is no motion, a fiftieth no change.
[[nodiscard]] GripParts parts_of(const Recording& recording, std::size_t channel,
                                 const std::vector<double>& predicted_mm, double full_kpa);

}  // namespace softgrip::sysid::health
