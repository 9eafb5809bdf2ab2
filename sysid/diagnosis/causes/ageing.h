#pragma once
// Defines a cause: the gain of the finger drifts during a measurement campaign. The gain changes in
// proportion to time, in proportion to the travelled distance, or only during a running-in time.

#include <algorithm>

#include "model/blocks/ageing.h"
#include "model/blocks/running_in.h"
#include "model/blocks/wear.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// The cause has three forms. With the start points of each form, the gain changes by about 10 % during the
/// campaign.
struct Ageing {
  static constexpr std::array advice{Advice::leave_vented, Advice::record_temperature};
  static constexpr Appears appears = Appears::displaced;
  static constexpr WhenChanged when_changed{
      "the gain has changed",
      {"Inspect the finger for cracks and bulges, and count the cycles since the installation of the finger.",
       "Install a new finger and record the same log. If the gain is normal again, the old finger has aged."},
      {{{HealthNumber::gain, Moves::either_way}}},
      {SizedBy::Of::span, "mean change of the gain at full pressure", "%", {}, 100}};

  struct WithTime : FormOf<model::Ageing> {
    static Starts starts(const Scales& s) {
      return every({{"gain_per_h", {-360 / s.campaign_s, 360 / s.campaign_s}}});
    }
  };
  struct RunningIn : FormOf<model::RunningIn> {
    static Starts starts(const Scales& s) {
      return every({{"run_in", {-0.1, 0.1}},
                    {"run_in_time_s",
                     {std::max(s.soonest_s(), 0.07 * s.campaign_s),
                      std::max(s.soonest_s(), 0.2 * s.campaign_s), 0.5 * s.campaign_s}}});
    }
    /// The running-in time is at least Scales::soonest_s() and at most half of the measurement campaign. A
    /// shorter running-in time would affect only one or two load cycles. A longer one cannot be identified,
    /// because the data contain only the beginning of the running-in.
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {{"run_in_time_s", s.soonest_s(), 0.5 * s.campaign_s}};
    }
  };
  struct WithUse : FormOf<model::Wear> {
    static Starts starts(const Scales& s) {
      const double way_m = 0.1 * s.campaign_s * s.span_mm * 1e-3;
      return every({{"gain_per_m", {-0.1 / way_m, 0.1 / way_m}}});
    }
  };

  using Forms = List<WithTime, RunningIn, WithUse>;
};

}  // namespace softgrip::sysid::causes
