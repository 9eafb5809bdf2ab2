#pragma once
// How well a recorded channel followed its reference, and where that question has no meaning.
//
// A grip asks for more than the object allows: from the touch on, the reference minus the displacement tells
// the object's size, not the quality of the control. So only free motion is rated.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::tools {

/// Over the samples that have a reference and a reading.
struct Tracking {
  bool grips_known =
      false;  ///< the log has columns `step` and `result`; otherwise every sample counts as free
  std::size_t free_samples = 0;
  double free_rmse_mm = 0;
  double free_largest_mm = 0;
  std::size_t gripping_samples = 0;
  double gripping_largest_mm = 0;  ///< reference minus displacement, at most
};
[[nodiscard]] Tracking tracking_of(const sysid::Log& log);

/// Reference minus displacement; NaN where one of them is missing. Empty: the log has no reference.
[[nodiscard]] std::vector<double> errors_of(const sysid::Log& log);

/// Per sample: 1 in every step that found an object or holds one, from its first sample on. A step is not
/// divided: a log does not say when the finger touched. All 0 without the columns `step` and `result`.
[[nodiscard]] std::vector<char> gripping_of(const sysid::Log& log);

/// "free motion: RMSE 0.04 mm, largest 0.14 mm; gripping: up to 4.4 mm short of the reference".
[[nodiscard]] std::string to_text(const Tracking& tracking);

}  // namespace softgrip::tools
