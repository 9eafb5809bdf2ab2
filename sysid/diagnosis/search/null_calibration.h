#pragma once
// Estimates how often the whole search names a cause in data without a cause, for the measured inputs.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A reduction is not significant if the null data reach it with a higher probability than this.
inline constexpr double null_level = 0.05;
/// Number of campaigns that can give a p-value of `null_level`.
inline constexpr std::size_t enough_nulls = 19;

/// Result of the search on campaigns that the refitted model generates.
struct NullCalibration {
  std::size_t campaigns = 0;
  std::size_t named = 0;            ///< campaigns in which the search named a cause
  double largest_gain_percent = 0;  ///< largest held-out error reduction of the named causes
  /// (1 + campaigns with at least the measured reduction) / (1 + campaigns). The smallest possible value is
  /// 1/(1 + campaigns).
  double p_value = 1;

  /// Returns true if the search reaches this error reduction in data without a cause too often.
  [[nodiscard]] bool reach_the_gain() const { return campaigns >= enough_nulls && p_value > null_level; }
};

struct NullOptions {
  std::size_t campaigns = enough_nulls;
  std::uint64_t seed = 1;
  std::function<void(std::size_t done)> progress;  ///< called from any thread, never concurrently
};

/// Simulates campaigns with the measured inputs. The readings are the prediction of the refitted model plus
/// an autoregressive process that resembles the refitted residual. Resampled innovations of the residual
/// drive the process (residual bootstrap, Freedman 1984). Therefore all remaining correlation of the residual
/// counts as noise.
/// @param gain_percent  held-out error reduction on the measured data.
[[nodiscard]] NullCalibration calibrate_on_nulls(const SearchData& data, const StructureFit& recalibrated,
                                                 double gain_percent, const Division& division,
                                                 const NullOptions& options);

}  // namespace softgrip::sysid
