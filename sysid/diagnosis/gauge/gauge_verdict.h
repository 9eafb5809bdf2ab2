#pragma once
// Applies a gauge check of the sensor to a selection of causes. It removes the alternatives that the gauge
// rules out. If it rules out the named cause, the remaining alternative replaces it.

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
  bool replaced = false;               ///< another cause replaced a named cause
  std::string sentence;                ///< result of the gauge check
};

struct GaugeQuestion {
  const GaugeFile& file;
  double noise_mm = 0;  ///< noise of the logs
  std::uint64_t seed = 1;
  /// False: the alternatives were fitted to other records. Named causes and their alternatives then do not
  /// change.
  bool may_replace = true;
};

/// Returns true if a gauge can separate the two causes: they make sensors of different static shapes.
[[nodiscard]] bool gauge_tells_apart(const Cause& one, const Cause& other);

/// Returns the information of a campaign about its sensor.
[[nodiscard]] GaugeScales gauge_scales(const std::vector<Record>& records, double noise_mm);

/// @param warnings  receives additional warnings for the verdict.
[[nodiscard]] GaugeEvidence weigh_gauge(const GaugeQuestion& question, const SearchData& data,
                                        const Division& division, Selection& selection,
                                        std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
