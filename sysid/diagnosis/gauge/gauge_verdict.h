#pragma once
// Applies a gauge check of the sensor to the causes that a search has selected. Removes the alternatives that
// the gauge readings rule out. If they rule out a named cause, the remaining alternative replaces it.

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
  double noise_mm = 0;  ///< noise of the logs
  std::uint64_t seed = 1;
  /// False: named causes and their alternatives are not changed, because the alternatives were fitted to
  /// other records.
  bool may_replace = true;
};

/// Returns true if a gauge can separate the two causes because the static shapes of their sensors differ.
[[nodiscard]] bool gauge_tells_apart(const Cause& one, const Cause& other);

/// Returns the noise and the range of the readings of a campaign.
[[nodiscard]] GaugeScales gauge_scales(const std::vector<Record>& records, double noise_mm);

/// Checks the hypotheses of a selection against the gauge readings and changes the selection accordingly.
/// @param warnings  receives further warnings for the verdict.
[[nodiscard]] GaugeEvidence weigh_gauge(const GaugeQuestion& question, const SearchData& data,
                                        const Division& division, Selection& selection,
                                        std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
