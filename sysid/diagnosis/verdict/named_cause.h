#pragma once
// Describes a cause that is named in a verdict, with the evidence for the cause.

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
  std::string formerly = {};  ///< deprecated name, which JSON files also contain; empty: none

  [[nodiscard]] bool determined() const { return has_interval && is_determined(ci95, value); }
};

struct NamedCause {
  Cause cause;
  std::size_t block_type = 0;  ///< type of the block that represents the cause in the model
  std::vector<CauseParameter> parameters;
  Spread heldout_gain_percent;
  Spread gain_mm2;  ///< reduction of the held-out mean square by the cause
  /// Reduction of the mean square error of the measured pressure [kPa^2]. Not set: the cause was not found in
  /// the measured pressure.
  std::optional<Spread> gain_kpa2;
  double inclusion = 1;  ///< inclusion frequency: share of the bootstrap samples in which structures with
                         ///< this cause have the lower loss
  std::vector<Cause> alternatives;
  std::vector<CandidateScore> candidates;
};

}  // namespace softgrip::sysid
