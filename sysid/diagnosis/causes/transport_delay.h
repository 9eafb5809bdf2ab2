#pragma once
// Defines a cause: there is a dead time between command and pressure.

#include "model/blocks/transport_delay.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct TransportDelay : FormOf<model::TransportDelay> {
  static constexpr std::array<std::string_view, 1> confounded_with{"valve_lag"};
  /// No mechanism is a pure dead time, because every real effect that delays the response also makes it
  /// slower.
  static constexpr bool is_ideal = true;
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "the pressure responds later than before",
      {"Check whether the tube, a filter or the exchange rate of the board was changed.",
       "Close the tube of the finger at the valve, step the command and measure the delay of the pressure "
       "there."},
      {{{HealthNumber::lag, Moves::up}}},
      {SizedBy::Of::number, "more dead time", "s", "delay_s"}};
  static Starts starts(const Scales&) { return every({{"delay_s", {0.02, 0.1, 0.25, 0.5}}}); }
};

}  // namespace softgrip::sysid::causes
