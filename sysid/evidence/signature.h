#pragma once
// Where the effect of a cause must appear in the data, and whether it does.

#include <cstddef>
#include <string_view>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The condition under which a cause acts.
enum class Appears {
  anywhere,
  at_rest,    ///< without pressure, too: a zero that moves does so at all displacements alike
  displaced,  ///< in proportion to the displacement
  held,       ///< while pressure is held
  moving,     ///< in proportion to the rate of the input, never at rest
};

/// What the finger was told and did in one bin.
struct OperatingPoint {
  double pressure_kpa = 0;    ///< of what drives the finger
  double rate_kpa_per_s = 0;  ///< of the drive, >= 0, held at its peak for a moment
  double motion = 0;          ///< what the base predicts, in the unit of the reading
};

/// How fast the drive of a record moves or has moved half a second before, at each sample [kPa/s].
[[nodiscard]] std::vector<double> rates_of(const Record& record);

/// For each bin whether the cause must act there. Pressure counts as none within limits::rest_share of its
/// range above the lowest, a rate as none within as much of the highest. A displacement and a rate count in
/// the upper half of their range.
[[nodiscard]] std::vector<bool> required_at(Appears appears, const std::vector<OperatingPoint>& conditions);

/// The recording that would show it, for a cause whose condition the data do not meet.
[[nodiscard]] std::string_view recording_for(Appears appears);

}  // namespace softgrip::sysid
