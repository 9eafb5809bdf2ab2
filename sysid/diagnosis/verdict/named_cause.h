#pragma once
// Describes a cause that a verdict names, and the evidence for this cause.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

/// A parameter of a named cause.
struct CauseParameter {
  std::string name;
  std::string unit;
  double value = 0;
  Interval ci95;
  bool has_interval = false;

  [[nodiscard]] bool determined() const { return has_interval && is_determined(ci95, value); }
};

struct NamedCause {
  Cause cause;
  std::size_t block_type = 0;  ///< type of the block with which the cause was found
  std::vector<CauseParameter> parameters;
  Spread heldout_gain_percent;
  Spread gain_mm2;  ///< reduction of the held-out mean square by the cause
  /// Reduction of the mean square error of the measured pressure [kPa^2]; not set: the cause was found
  /// without this pressure.
  std::optional<Spread> gain_kpa2;
  double inclusion =
      1;  ///< inclusion frequency: weight of the structures with this cause among all plausible structures
  std::vector<Cause> alternatives;
  std::vector<CandidateScore> candidates;
};

}  // namespace softgrip::sysid
