#pragma once
// How often the whole search would name a cause where there is none, on these very inputs.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/search.h"

namespace softgrip::sysid {

/// A gain that nulls reach more often than this is none.
inline constexpr double null_level = 0.05;
/// So many campaigns can show a p-value of `null_level`.
inline constexpr std::size_t enough_nulls = 19;

/// Campaigns in which the recalibrated model is the truth, searched like the measured one.
struct NullCalibration {
  std::size_t campaigns = 0;
  std::size_t named = 0;            ///< in which the search named something
  double largest_gain_percent = 0;  ///< of what it named, held out
  /// (1 + campaigns with at least the measured gain) / (1 + campaigns): the smallest that can be told is
  /// 1/(1 + campaigns).
  double p_value = 1;

  /// The gain is one that the search makes out of noise as well, or may be.
  [[nodiscard]] bool reach_the_gain() const { return campaigns >= enough_nulls && p_value > null_level; }
};

struct NullOptions {
  std::size_t campaigns = enough_nulls;
  std::uint64_t seed = 1;
  std::function<void(std::size_t done)> progress;  ///< from any thread, never from two at once
};

/// Every campaign has the measured one's inputs; its readings are the recalibrated model's prediction plus an
/// autoregressive process like the recalibrated residual, driven by resampled innovations of it (the residual
/// bootstrap, Freedman 1984). So whatever is left of correlation in the residual is taken for noise.
/// @param gain_percent  what the search gained on the measured data, held out.
[[nodiscard]] NullCalibration calibrate_on_nulls(const SearchData& data, const StructureFit& recalibrated,
                                                 double gain_percent, const Division& division,
                                                 const NullOptions& options);

}  // namespace softgrip::sysid
