#pragma once
// What is wrong with the air itself: no cause of a model of a finger, but of what becomes of one.

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

inline constexpr std::array causes_without_block{leak, blocked_line};

}  // namespace softgrip::sysid
