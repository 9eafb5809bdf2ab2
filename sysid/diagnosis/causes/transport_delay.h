#pragma once
// Defines a cause: there is a dead time between command and pressure.

#include "model/blocks/transport_delay.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct TransportDelay : FormOf<model::TransportDelay> {
  static constexpr std::array<std::string_view, 1> confounded_with{"valve_lag"};
  /// No real mechanism is a pure dead time: every effect that delays the response also makes the response
  /// slower.
  static constexpr bool is_ideal = true;
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "the pressure responds later than before",
      {"Check whether the tube, a filter or the exchange rate of the board was changed.",
       "Close the tube of the finger at the valve. Step the command and measure the delay of the pressure at "
       "the valve."},
      {{{HealthNumber::lag, Moves::up}}},
      {SizedBy::Of::number, "increase of the dead time", "s", "delay_s"}};
  static Starts starts(const Scales& s) {
    return every({{"delay_s", s.times_s({0.02, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0})}});
  }
};

}  // namespace softgrip::sysid::causes
