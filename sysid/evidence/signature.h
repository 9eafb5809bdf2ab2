#pragma once
// Finds the bins in which a cause must have an effect.

#include <cstddef>
#include <string_view>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The operating points at which a cause must have an effect.
enum class Appears {
  anywhere,
  at_rest,    ///< at zero pressure as well, because a shifted zero affects all displacements equally
  displaced,  ///< with an effect proportional to the displacement
  held,       ///< while a pressure is held
  moving,     ///< with an effect proportional to the rate of the input, zero at rest
};

/// Input and predicted motion of the finger in one bin.
struct OperatingPoint {
  double pressure_kpa = 0;    ///< pressure that drives the finger
  double rate_kpa_per_s = 0;  ///< rate of the driving pressure after a peak detector, >= 0; see rates_of()
  double motion = 0;          ///< displacement predicted by the model, in the unit of the reading
};

/// Returns the rate |dp/dt| of the driving pressure at each sample [kPa/s], after a peak detector that decays
/// with a time constant of 0.5 s.
[[nodiscard]] std::vector<double> rates_of(const Record& record);

/// Returns one flag per bin: true if the cause must have an effect there. Pressure and rate count as zero up
/// to limits::rest_share of their range. Displacement and rate count as high in the upper half of their
/// range.
[[nodiscard]] std::vector<bool> required_at(Appears appears, const std::vector<OperatingPoint>& conditions);

/// Returns advice on a recording that would show the cause, for data that do not meet its condition.
[[nodiscard]] std::string_view recording_for(Appears appears);

}  // namespace softgrip::sysid
