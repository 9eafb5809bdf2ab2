#pragma once
// Describes a cause that a verdict names, with its evidence.

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

/// A cause is named alone at this inclusion frequency and above.
inline constexpr double full_inclusion = 0.95;

struct NamedCause {
  Cause cause;
  std::size_t block_type = 0;  ///< block type of the form in which it was found
  std::vector<CauseParameter> parameters;
  Spread heldout_gain_percent;
  Spread gain_mm2;  ///< decrease of the held-out mean square with the cause
  /// Decrease of the mean square of the measured pressure, if the pressure was used to judge the cause
  /// [kPa^2].
  std::optional<Spread> gain_kpa2;
  double inclusion = 1;  ///< weight of the structures with this cause in the confidence set
  std::vector<Cause> alternatives;
  std::vector<CandidateScore> candidates;
};

}  // namespace softgrip::sysid
