#pragma once
// Detects that the measured pressure stays below the command by more than scale errors can explain. The cause
// is then a leak or a wrong scale.

#include <cstdint>
#include <optional>

#include "sysid/diagnosis/verdict/measured_valve.h"

namespace softgrip::sysid {

/// Largest difference between the scales of the regulator and of the pressure sensor that is explained
/// without a leak. Each of the two scales has an error of 1 % according to its data sheet.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< parts of the valve model, including the leak
  ValveStage stage;  ///< parameters of the valve model with the leak; the sensor gain is 1
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< losses of the model without a leak and with a sensor gain of 1
  double highest_kpa = 0;    ///< highest measured pressure
  double missing_kpa = 0;    ///< lost pressure when the measured pressure has its highest value
};

/// Searches for a leak. Returns nullopt in three cases. First, the fitted gain of the pressure sensor is
/// within the scale errors. Second, a model with a leak fits significantly worse than a model with this gain.
/// Third, most of the error that remains without leak and gain has another cause.
/// @param scaled  fit of `parts`, which contain no leak, with gain and zero offset of the pressure sensor.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
