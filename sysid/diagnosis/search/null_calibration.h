#pragma once
// Estimates how often the search names a cause in simulated data that contain no cause. The simulation uses
// the measured inputs.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

/// Smallest number of campaigns with which the p-value can be as small as 1 - limits::probability.
inline constexpr std::size_t enough_nulls = limits::fewest_events - 1;

/// Result of the search on simulated campaigns without a cause. The refitted model generates these campaigns.
struct NullCalibration {
  std::size_t campaigns = 0;
  std::size_t named = 0;            ///< number of campaigns in which the search named a cause
  double largest_gain_percent = 0;  ///< largest held-out error reduction by a named cause
  /// (1 + number of campaigns with at least the measured error reduction) / (1 + number of campaigns). Its
  /// smallest possible value is 1/(1 + number of campaigns).
  double p_value = 1;

  /// Returns true if the measured error reduction is not significant, because the search often reaches it in
  /// data without a cause.
  [[nodiscard]] bool reach_the_gain() const {
    return campaigns >= enough_nulls && p_value > 1 - limits::probability;
  }
};

struct NullOptions {
  std::size_t campaigns = enough_nulls;
  std::uint64_t seed = 1;
  /// Called from any thread, but never from two threads at once.
  std::function<void(std::size_t done)> progress;
};

/// Simulates campaigns with the measured inputs and applies the search to them. The simulated readings are
/// the prediction of the refitted model plus noise. The noise comes from an autoregressive model of the
/// residual, which is driven by resampled innovations (residual bootstrap, Freedman 1984). Therefore all
/// remaining correlation of the residual counts as noise.
/// @param gain_percent  held-out error reduction on the measured data.
[[nodiscard]] NullCalibration calibrate_on_nulls(const SearchData& data, const StructureFit& recalibrated,
                                                 double gain_percent, const Division& division,
                                                 const NullOptions& options);

}  // namespace softgrip::sysid
