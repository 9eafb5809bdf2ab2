#pragma once
// Finds the bins in which the effect of a cause must appear.

#include <cstddef>
#include <string_view>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The condition under which a cause acts.
enum class Appears {
  anywhere,
  at_rest,    ///< at zero pressure, too: a shifted zero affects all displacements equally
  displaced,  ///< in proportion to the displacement
  held,       ///< while pressure is held
  moving,     ///< in proportion to the rate of the input; zero at rest
};

/// Input and predicted motion of the finger in one bin.
struct OperatingPoint {
  double pressure_kpa = 0;    ///< pressure that drives the finger
  double rate_kpa_per_s = 0;  ///< rate of the driving pressure, >= 0, with a decaying peak hold
  double motion = 0;          ///< displacement that the model predicts, in the unit of the reading
};

/// Returns the rate |dp/dt| of the driving pressure at each sample [kPa/s], after a peak detector that decays
/// with a time constant of 0.5 s.
[[nodiscard]] std::vector<double> rates_of(const Record& record);

/// Returns for each bin whether the cause must act there. Pressure and rate count as zero up to
/// limits::rest_share of their range. Displacement and rate count as high in the upper half of their range.
[[nodiscard]] std::vector<bool> required_at(Appears appears, const std::vector<OperatingPoint>& conditions);

/// Returns advice on which recording would show the cause if the data do not meet its condition.
[[nodiscard]] std::string_view recording_for(Appears appears);

}  // namespace softgrip::sysid
