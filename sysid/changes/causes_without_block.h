#pragma once
// Declares the causes of a change that no block of a model describes: faults of the air supply, and a load on
// the finger.

#include <array>
#include <string_view>

#include "sysid/diagnosis/causes/form.h"
#include "sysid/diagnosis/causes/leak.h"

namespace softgrip::sysid {

struct CauseWithoutBlock {
  std::string_view id, title;
  WhenChanged when_changed;
  Appears appears = Appears::anywhere;
};

inline constexpr CauseWithoutBlock blocked_line{
    "blocked_line",
    "Blocked line",
    {"the air flow of the line to the finger is reduced",
     {"Blow through the tube, and check the tube for kinks and water.",
      "Replace the tube by a new tube of equal length, then record the same log again."},
     {{{HealthNumber::lag, Moves::up}}},
     {SizedBy::Of::number, "additional filling time", "s", "filling_s"}},
    Appears::moving};

inline constexpr CauseWithoutBlock leak{
    causes::Leak::id,
    "Leak",
    {"the pressure falls while it should be constant",
     {"Hold full pressure. Listen for a leak along the tube, the fittings and the finger, or spray them with "
      "soapy water.",
      "Close the tube first at the valve and then at the finger. Note in which of the two cases the pressure "
      "still falls."},
     {{{HealthNumber::pressure_loss, Moves::up},
       {HealthNumber::leak, Moves::up},
       {HealthNumber::gain, Moves::down}}},
     {SizedBy::Of::number, "pressure loss per second while the line is closed", "kPa", "loss_kpa_per_s"}},
    Appears::held};

/// A weight or a preload changes the gain and the zero offset at the same time. A change of the finger and a
/// separate change of the zero offset can produce the same readings.
inline constexpr CauseWithoutBlock payload{
    "payload",
    "Payload",
    {"a weight or a preload acts on the finger",
     {"Remove all objects that are attached to the finger or touch the finger, then record the same log "
      "again.",
      "Record one log with the finger pointing down and one log with the finger pointing up. The effect of a "
      "weight has opposite signs in these two logs."},
     {},
     {SizedBy::Of::span, "mean change of the gain at full pressure", "%", {}, 100}},
    Appears::displaced};

inline constexpr std::array causes_without_block{leak, blocked_line, payload};

}  // namespace softgrip::sysid
