#pragma once
// The picture of a recording: per channel pressure, displacement and tracking error, and what the rig did.

#include <string>

#include "sysid/pages/figure.h"
#include "tools/recordings/recording.h"

namespace softgrip::tools {

[[nodiscard]] sysid::Figure figure_of(const Recording& recording);

/// Two recordings: each in a column of its own, or the second one's curves among the first one's, channel by
/// channel, both on their own times.
enum class Pairing { beside, over };
[[nodiscard]] sysid::Figure figure_of(const Recording& first, const Recording& second, Pairing pairing);

/// What was recorded from `from_s` to `to_s`, at the times at which it was; one channel, or all where
/// `channel` is empty. The error is a sentence.
[[nodiscard]] tl::expected<Recording, std::string> part_of(const Recording& recording,
                                                           const std::string& channel, double from_s,
                                                           double to_s);

}  // namespace softgrip::tools
