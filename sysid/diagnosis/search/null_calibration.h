#pragma once
// Estimates how often the search names a cause in simulated data without a cause, using the measured inputs.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// Significance level: an error reduction is not significant if it occurs in the null data with a higher
/// probability.
inline constexpr double null_level = 0.05;
/// Smallest number of campaigns for which the p-value can be as small as `null_level`.
inline constexpr std::size_t enough_nulls = 19;

/// Result of the search on null campaigns, which the refitted model generates.
struct NullCalibration {
  std::size_t campaigns = 0;
  std::size_t named = 0;            ///< campaigns in which the search named a cause
  double largest_gain_percent = 0;  ///< largest held-out error reduction of the named causes
  /// (1 + number of campaigns with at least the measured error reduction) / (1 + campaigns). The smallest
  /// possible value is 1/(1 + campaigns).
  double p_value = 1;

  /// Returns true if the error reduction is not significant, because the search reaches it too often in data
  /// without a cause.
  [[nodiscard]] bool reach_the_gain() const { return campaigns >= enough_nulls && p_value > null_level; }
};

struct NullOptions {
  std::size_t campaigns = enough_nulls;
  std::uint64_t seed = 1;
  std::function<void(std::size_t done)> progress;  ///< called from any thread, never concurrently
};

/// Simulates campaigns with the measured inputs and applies the search to them. The readings are the
/// prediction of the refitted model plus noise from an autoregressive model of the refitted residual.
/// Resampled innovations of the residual drive the autoregressive model (residual bootstrap, Freedman 1984).
/// Therefore all remaining correlation of the residual counts as noise.
/// @param gain_percent  held-out error reduction on the measured data.
[[nodiscard]] NullCalibration calibrate_on_nulls(const SearchData& data, const StructureFit& recalibrated,
                                                 double gain_percent, const Division& division,
                                                 const NullOptions& options);

}  // namespace softgrip::sysid
