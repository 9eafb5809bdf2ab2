#pragma once
// The picture of a recording: per channel pressure, displacement and tracking error, and what the rig did.

#include <string>
#include <vector>

#include "tools/recording.h"

namespace softgrip::tools {

/// How well a channel followed its reference, over the samples that have both.
struct Tracking {
  std::size_t samples = 0;
  double rmse_mm = 0;
  double largest_mm = 0;
};
[[nodiscard]] Tracking tracking_of(const sysid::Log& log);

/// The whole picture as an SVG document.
[[nodiscard]] std::string picture_of(const Recording& recording);

}  // namespace softgrip::tools
