#pragma once
// Defines a cause: the reading lags behind the displacement.

#include "model/blocks/sensor_lag.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct SensorLag : FormOf<model::SensorLag> {
  static constexpr std::array<std::string_view, 1> confounded_with{"transport_delay"};
  static constexpr bool makes_distinguishable = true;
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "the reading responds more slowly than before",
      {"Check the filter setting of the sensor or its amplifier.",
       "Move the target quickly by hand and compare the reading with that of a second sensor."},
      {{{HealthNumber::lag, Moves::up}}},
      {SizedBy::Of::number, "lag of the sensor", "s", "time_constant_s"}};

  static Starts starts(const Scales& s) {
    return every({{"time_constant_s", s.times_s({0.02, 0.1, 0.3, 0.6})}});
  }
};

}  // namespace softgrip::sysid::causes
