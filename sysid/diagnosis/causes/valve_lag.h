#pragma once
// Defines a cause: the pressure follows the command with a lag, because of the regulator and the tube.

#include "model/blocks/valve_lag.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct ValveLag : FormOf<model::ValveLag> {
  static constexpr std::array<std::string_view, 1> confounded_with{"transport_delay"};
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "the pressure responds more slowly than before",
      {"Check for a kinked tube and a clogged filter or silencer, and check the supply pressure during "
       "motion.",
       "Close the tube of the finger at the valve and step the command. If the pressure at the valve is "
       "slow, the valve is the cause."},
      {{{HealthNumber::lag, Moves::up}}},
      {SizedBy::Of::number, "increase of the lag of the valve", "s", "time_constant_s"}};
  static Starts starts(const Scales& s) {
    return every({{"time_constant_s", s.times_s({0.02, 0.1, 0.3, 0.6})}});
  }
};

}  // namespace softgrip::sysid::causes
