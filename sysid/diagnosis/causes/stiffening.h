#pragma once
// Defines a cause: the gain changes with the displacement. The change is the same for loading and unloading.

#include "model/blocks/stiffening.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct Stiffening : FormOf<model::Stiffening> {
  static constexpr std::array advice{Advice::change_load};
  static constexpr std::string_view indistinguishable = "sensor_nonlinearity";
  static constexpr std::array<std::string_view, 1> counterparts{"sensor_nonlinearity"};
  static constexpr WhenChanged when_changed{
      "the stiffness increases with displacement",
      {"Bend the vented finger by hand and check if an object blocks its motion.",
       "Compare the sensor with a gauge at five positions. If sensor and gauge agree, the finger has "
       "changed."}};

  static Starts starts(const Scales& s) {
    return every({{"stiffening_per_mm", {-0.3 / s.span_mm, 0.1 / s.span_mm, 0.5 / s.span_mm}}});
  }
};

}  // namespace softgrip::sysid::causes
