#pragma once
// Applies a gauge check of the sensor to the causes that a search has selected. Alternatives that the gauge
// readings rule out are removed. If a named cause is ruled out, its remaining alternative replaces it.

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
  bool replaced = false;               ///< true: another cause replaced a named cause
  std::string sentence;                ///< result of the gauge check as a sentence
};

struct GaugeQuestion {
  const GaugeFile& file;
  double noise_mm = 0;  ///< standard deviation of the noise in the logs
  std::uint64_t seed = 1;
  /// False: the named causes and their alternatives are not changed, because the alternatives were not fitted
  /// to the same records.
  bool may_replace = true;
};

/// Returns true if a gauge can separate the two causes because they imply different static shapes of the
/// sensor.
[[nodiscard]] bool gauge_tells_apart(const Cause& one, const Cause& other);

/// Returns the noise and the range of the readings in the logs.
[[nodiscard]] GaugeScales gauge_scales(const std::vector<Record>& records, double noise_mm);

/// Tests the hypotheses of a selection with the gauge readings. Removes or replaces the causes that the
/// readings rule out.
/// @param warnings  list to which warnings for the verdict are added.
[[nodiscard]] GaugeEvidence weigh_gauge(const GaugeQuestion& question, const SearchData& data,
                                        const Division& division, Selection& selection,
                                        std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
