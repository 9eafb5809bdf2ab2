#pragma once
// Estimates how often the search names a cause in data that contain no cause. The data are simulated with the
// measured inputs.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

/// Smallest number of simulated campaigns for which the p-value can be as small as 1 - limits::probability (5
/// %).
inline constexpr std::size_t enough_nulls = limits::fewest_events - 1;

/// Results of the search on simulated campaigns without a cause. The readings of these campaigns are
/// simulated with the refitted model.
struct NullCalibration {
  double gain_percent = 0;  ///< held-out error reduction on the measured data
  std::size_t campaigns = 0;
  std::size_t named = 0;            ///< number of campaigns in which the search named a cause
  double largest_gain_percent = 0;  ///< largest held-out error reduction by a cause that the search named
  /// p-value of the error reduction. It is (1 + n) / (1 + number of campaigns), where n is the number of
  /// campaigns with at least the error reduction of the measured data. It is therefore at least 1/(1 + number
  /// of campaigns).
  double p_value = 1;

  /// Returns true if the error reduction on the measured data is not significant. This is the case if the
  /// search reaches the same reduction too often in data without a cause.
  [[nodiscard]] bool reach_the_gain() const {
    return campaigns >= enough_nulls && p_value > 1 - limits::probability;
  }
};

struct NullOptions {
  std::size_t campaigns = enough_nulls;
  std::uint64_t seed = 1;
  /// Function that receives the number of finished campaigns. Any thread may call it, but two threads never
  /// call it at the same time.
  std::function<void(std::size_t done)> progress;
};

/// Simulates campaigns with the measured inputs and searches for causes in them. A simulated reading is the
/// prediction of the refitted model plus noise. The noise is simulated with an autoregressive model of the
/// residual and resampled innovations (residual bootstrap, Freedman 1984). All correlation that remains in
/// the residual therefore counts as noise.
/// @param gain_percent  held-out error reduction on the measured data.
[[nodiscard]] NullCalibration calibrate_on_nulls(const SearchData& data, const StructureFit& recalibrated,
                                                 double gain_percent, const Division& division,
                                                 const NullOptions& options);

}  // namespace softgrip::sysid
