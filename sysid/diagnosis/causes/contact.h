#pragma once
// Defines a cause: the stiffness increases beyond a position because of an object or a stop.

#include "model/blocks/contact.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct Contact : FormOf<model::Contact> {
  static constexpr std::array advice{Advice::change_load};
  static constexpr std::array<std::string_view, 2> counterparts{"sensor_saturation", "sensor_nonlinearity"};
  static constexpr bool is_stop = true;
  static constexpr WhenChanged when_changed{
      "an object or a stop blocks the finger beyond a position",
      {"Move the finger by hand through its range and check which objects it touches.",
       "Remove the object or the stop, then record the same log again."},
      {{{HealthNumber::contact, Moves::either_way}}}};

  static Starts starts(const Scales& s) {
    return every({{"position_mm",
                   {0.35 * s.span_mm, 0.55 * s.span_mm, 0.7 * s.span_mm, 0.85 * s.span_mm, 0.95 * s.span_mm}},
                  {"stiffening", {0.2, 1.5}}});
  }
  /// The position of the contact is between 5 % and 100 % of the span of the readings. With a smaller
  /// position, the contact would have the same effect as a smaller gain. With a larger position, the contact
  /// would not affect the readings.
  static Bounds bounds(const Scales& s, const model::Model&) {
    return {{"position_mm", 0.05 * s.span_mm, s.span_mm}};
  }
};

}  // namespace softgrip::sysid::causes
