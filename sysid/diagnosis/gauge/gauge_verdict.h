#pragma once
// What a gauge check of the sensor does to a selection of causes: rivals that it rules out go, and where the
// named cause is ruled out, the one that is left takes its place.

#include <cstdint>
#include <string>
#include <vector>

#include "sysid/diagnosis/gauge/gauge_check.h"
#include "sysid/diagnosis/search/selection.h"

namespace softgrip::sysid {

struct GaugeEvidence {
  GaugeFile file;
  GaugeCheck check;
  std::vector<std::string> ruled_out;  ///< ids of causes that stood and do not stand any more
  bool replaced = false;               ///< a named cause gave its place to another one
  std::string sentence;                ///< what the gauge shows
};

struct GaugeQuestion {
  const GaugeFile& file;
  double noise_mm = 0;  ///< of the logs
  std::uint64_t seed = 1;
  /// False: the fits of the rivals are of other records; what is named and its rivals stay.
  bool may_replace = true;
};

/// Whether a gauge could tell: the two make sensors of different static shapes.
[[nodiscard]] bool gauge_tells_apart(const Cause& one, const Cause& other);

/// What the readings of a campaign know of its sensor.
[[nodiscard]] GaugeScales gauge_scales(const std::vector<Record>& records, double noise_mm);

/// @param warnings  gets what a reader of the verdict must know besides.
[[nodiscard]] GaugeEvidence weigh_gauge(const GaugeQuestion& question, const SearchData& data,
                                        const Division& division, Selection& selection,
                                        std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
