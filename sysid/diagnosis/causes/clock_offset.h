#pragma once
// Defines a cause: the reading reacts before the command changes.

#include "model/blocks/clock_offset.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

/// This cause describes readings with time stamps that are too early. Time stamps that are too late have the
/// same effect as a dead time, and no log can separate these two effects.
struct ClockOffset : FormOf<model::ClockOffset> {
  static constexpr bool is_ideal = true;
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "the reading changes before its command",
      {"Compare the clocks of the devices that record command and reading.",
       "Record command and reading with one device, then record the same log again."},
      {},
      {SizedBy::Of::number, "the reading is ahead by", "s", "lead_s"}};

  static Starts starts(const Scales& s) { return every({{"lead_s", s.times_s({0.01, 0.03, 0.1, 0.3})}}); }
};

}  // namespace softgrip::sysid::causes
