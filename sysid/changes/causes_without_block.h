#pragma once
// Causes of a change without a block of a model: the air supply and the load.

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
    {"the line to the finger lets less air through",
     {"Blow the tube through, look for kinks and for water in it.",
      "Swap the tube for a new one of the same length and record the same log again."},
     {{{HealthNumber::lag, Moves::up}}},
     {SizedBy::Of::number, "more time to fill", "s", "filling_s"}},
    Appears::moving};

inline constexpr CauseWithoutBlock leak{
    causes::Leak::id,
    "Leak",
    {"pressure is lost while it should hold",
     {"Hold full pressure and listen or spray soapy water along tube, fittings and finger.",
      "Close the tube at the valve, then at the finger, and see at which end the pressure still falls."},
     {{{HealthNumber::pressure_loss, Moves::up},
       {HealthNumber::leak, Moves::up},
       {HealthNumber::gain, Moves::down}}},
     {SizedBy::Of::number, "pressure lost in a second with the line shut", "kPa", "loss_kpa_per_s"}},
    Appears::held};

/// A weight or a preload changes gain and zero together. The readings do not separate it from a change of the
/// finger together with a change of the zero.
inline constexpr CauseWithoutBlock payload{
    "payload",
    "Payload",
    {"a weight or a preload acts on the finger",
     {"Remove everything that is attached to the finger or touches it, and record the same log again.",
      "Record one log in which the finger points down and one in which it points up: a weight changes "
      "sides."},
     {},
     {SizedBy::Of::span, "gain at full pressure, on average", "%", {}, 100}},
    Appears::displaced};

inline constexpr std::array causes_without_block{leak, blocked_line, payload};

}  // namespace softgrip::sysid
