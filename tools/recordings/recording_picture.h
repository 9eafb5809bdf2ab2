#pragma once
// Draws a recording: pressure, displacement and tracking error of each channel, and the states of the rig.

#include <string>

#include "sysid/pages/figure.h"
#include "sysid/recordings/recording.h"

namespace softgrip::tools {

[[nodiscard]] sysid::Figure figure_of(const sysid::Recording& recording);

/// The arrangement of two recordings: side by side in columns, or overlaid per channel. Each recording keeps
/// its own time axis.
enum class Pairing { beside, over };
[[nodiscard]] sysid::Figure figure_of(const sysid::Recording& first, const sysid::Recording& second,
                                      Pairing pairing);

/// Returns the part of a recording from `from_s` to `to_s` with unchanged times. An empty `channel` selects
/// all channels. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<sysid::Recording, std::string> part_of(const sysid::Recording& recording,
                                                                  const std::string& channel, double from_s,
                                                                  double to_s);

}  // namespace softgrip::tools
