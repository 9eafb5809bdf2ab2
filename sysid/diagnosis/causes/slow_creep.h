#pragma once
// Defines a cause: the finger creeps more slowly than the slowest creep branch of the model.

#include <algorithm>

#include "model/blocks/slow_creep.h"
#include "sysid/diagnosis/causes/form.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid::causes {

struct SlowCreep : FormOf<model::SlowCreep> {
  static constexpr std::array advice{Advice::leave_vented};
  static constexpr WhenChanged when_changed{
      "within minutes, the finger creeps more than before",
      {"Hold full pressure for ten minutes and watch the reading.",
       "Check for a loose mounting or a detached layer. Repair the defect and record again."},
      {{{HealthNumber::creep, Moves::up}}}};

  static Starts starts(const Scales& s) {
    const double gain = s.gain_mm_per_kpa();
    return every({{"gain_mm_per_kpa", {0.05 * gain, 0.2 * gain, 0.8 * gain}},
                  {"time_constant_s", {0.15 * s.campaign_s, 0.5 * s.campaign_s, 2 * s.campaign_s}}});
  }
  /// With a smaller time constant, the creep would have the same effect as a creep branch of the base
  /// structure. With a larger time constant, the creep would be a linear change with time in these data.
  static Bounds bounds(const Scales& s, const model::Model& model) {
    double slowest_s = 0;
    for (const double tau_s : branch_time_constants_s(model)) slowest_s = std::max(slowest_s, tau_s);
    return {{"time_constant_s", std::min(1.5 * slowest_s, 0.15 * s.campaign_s), 20 * s.campaign_s}};
  }
};

}  // namespace softgrip::sysid::causes
