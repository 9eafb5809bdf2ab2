#pragma once
// Defines a cause: the pressure saturates at a limit, although the command is higher.

#include "model/blocks/pressure_saturation.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct PressureSaturation : FormOf<model::PressureSaturation> {
  static constexpr WhenChanged when_changed{
      "the pressure does not reach the command",
      {"Read the supply gauge while the highest pressure is commanded.",
       "Compare the regulator's range and the board's scaling with the rig file."},
      {{{HealthNumber::pressure_loss, Moves::up}}},
      {SizedBy::Of::number, "highest pressure", "kPa", "limit_kpa"}};
  static Starts starts(const Scales& s) {
    return every({{"limit_kpa",
                   {0.97 * s.largest_kpa, 0.9 * s.largest_kpa, 0.75 * s.largest_kpa, 0.6 * s.largest_kpa}}});
  }
};

}  // namespace softgrip::sysid::causes
