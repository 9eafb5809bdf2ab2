#pragma once
// Draws a recording: pressure, displacement and tracking error of each channel, and the states of the rig.
// Computes the tracking error of a recorded channel.
//
// During a grip, the reference lies beyond the surface of the object. After the contact, the difference
// between reference and displacement therefore depends on the size of the object, not on the quality of the
// control. Hence the tracking error is computed only for free motion.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/logs/log.h"
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

/// Statistics of the tracking error over the samples that have a reference and a reading.
struct Tracking {
  bool grips_known = false;  ///< true: the log has the columns `step` and `result`; false: every sample
                             ///< counts as free motion
  std::size_t free_samples = 0;
  double free_rmse_mm = 0;
  double free_largest_mm = 0;
  std::size_t gripping_samples = 0;
  double gripping_largest_mm = 0;  ///< largest value of reference minus displacement during grips [mm]
};
[[nodiscard]] Tracking tracking_of(const sysid::Log& log);

/// Returns reference minus displacement for each sample [mm], or NaN if either value is missing. Returns an
/// empty list if the log has no reference.
[[nodiscard]] std::vector<double> errors_of(const sysid::Log& log);

/// Returns 1 for each sample of a step in which an object was detected or held, else 0. The value is 1 for
/// all samples of the step, because a log does not state the time of the contact. All values are 0 if the log
/// has no columns `step` and `result`.
[[nodiscard]] std::vector<char> gripping_of(const sysid::Log& log);

/// Returns the statistics as text: "free motion: RMSE 0.04 mm, largest 0.14 mm; gripping: up to 4.4 mm below
/// the reference".
[[nodiscard]] std::string to_text(const Tracking& tracking);

}  // namespace softgrip::tools
