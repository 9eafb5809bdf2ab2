#pragma once
// Applies a gauge check of the sensor to the causes that a search has selected. Alternatives that contradict
// the gauge readings are removed. If a named cause contradicts the gauge readings, its remaining alternative
// replaces it.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/diagnosis/gauge/gauge_check.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

struct GaugeEvidence {
  GaugeFile file;
  GaugeCheck check;
  std::vector<std::string> ruled_out;  ///< ids of the causes that the gauge ruled out
  bool replaced = false;               ///< true: the check has replaced a named cause
  std::string sentence;                ///< sentence on the result of the gauge check
};

struct GaugeQuestion {
  const GaugeFile& file;
  double noise_mm = 0;  ///< standard deviation of the noise of the readings in the logs
  std::uint64_t seed = 1;
  /// False: named causes and alternatives stay unchanged, because the alternatives were not fitted to these
  /// records.
  bool may_replace = true;
};

/// Returns true if a gauge can separate the two causes. This is possible if the causes differ in the static
/// curve of the sensor (reading over displacement).
[[nodiscard]] bool gauge_tells_apart(const Cause& one, const Cause& other);

/// Returns the noise and the range of the readings in the logs.
[[nodiscard]] GaugeScales gauge_scales(const std::vector<Record>& records, double noise_mm);

/// Tests the causes of a selection with the gauge readings. Removes or replaces the causes that contradict
/// the readings.
/// @param warnings  list to which the function adds warnings for the verdict.
[[nodiscard]] GaugeEvidence weigh_gauge(const GaugeQuestion& question, const SearchData& data,
                                        const Division& division, Selection& selection,
                                        std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
