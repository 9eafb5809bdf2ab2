#pragma once
// Defines a cause: the reading contains a sustained oscillation that does not depend on the command.

#include "model/blocks/periodic_disturbance.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct PeriodicDisturbance : FormOf<model::PeriodicDisturbance> {
  static constexpr WhenChanged when_changed{
      "the reading oscillates independently of the command",
      {"Switch off neighbouring machines and pumps one by one and watch the reading.",
       "Check the shielding and the ground of the sensor, and record a log while the finger is vented."},
      {},
      {SizedBy::Of::amplitude, "oscillation of", "mm"}};
  /// Returns one start point for each significant line in the spectrum of the residual.
  static Starts starts(const Scales& s) {
    Starts starts;
    for (const Line& line : s.residual_lines) {
      starts.push_back(start(
          {{"sine_mm", line.sine_mm}, {"cosine_mm", line.cosine_mm}, {"frequency_hz", line.frequency_hz}}));
    }
    return starts;
  }
  static Bounds bounds(const Scales& s, const model::Model&) {
    return {{"frequency_hz", slowest_oscillation_hz(s.campaign_s)}};
  }
};

}  // namespace softgrip::sysid::causes
