#pragma once
// Reads the scale and the offset of a converter's channel from its attributes.

#include <filesystem>
#include <string>

namespace softgrip::drivers {

/// The value of a channel in V, mA or kPa is (raw + offset) * scale.
struct IioScaling {
  double scale = 1;   ///< factor from the raw number to V, mA or kPa; 0: the converter has no scale
  double offset = 0;  ///< number that is added to the raw number
};

/// Reads the scaling of a channel's raw number. For a channel without attributes of its own, reads the
/// attributes that all channels of this type share.
[[nodiscard]] IioScaling scaling_of(const std::filesystem::path& folder, const std::string& channel,
                                    bool output);

/// Returns the scaling of a channel whose attribute contains the number in mV, mA or kPa.
[[nodiscard]] IioScaling scaling_of_processed(const std::string& channel) noexcept;

}  // namespace softgrip::drivers
