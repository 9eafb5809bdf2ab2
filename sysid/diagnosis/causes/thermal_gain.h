#pragma once
// Defines a cause: the gain of the finger depends on the temperature.

#include "model/blocks/thermal_gain.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct ThermalGain : FormOf<model::ThermalGain> {
  static constexpr Column needs = Column::temperature_c;
  static constexpr std::array advice{Advice::vary_temperature};
  static constexpr WhenChanged when_changed{
      "the gain depends on the temperature",
      {"Record again at a different room temperature.",
       "Check for a heat source near the finger or the sensor."},
      {{{HealthNumber::gain, Moves::either_way}}},
      {SizedBy::Of::number, "change of the gain per degree", "%", "gain_per_c", 100}};

  static Starts starts(const Scales&) { return every({{"gain_per_c", {-0.01, 0.01}}}); }
};

}  // namespace softgrip::sysid::causes
