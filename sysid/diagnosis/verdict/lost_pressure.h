#pragma once
// Finds a measured pressure that stays further below the command than scale errors explain. Its cause is a
// leak or a wrong scale.

#include <cstdint>
#include <optional>

#include "sysid/diagnosis/verdict/measured_valve.h"

namespace softgrip::sysid {

/// Largest difference between the scales of the regulator and the pressure sensor that needs no leak as an
/// explanation. By their data sheets, each of them has an error of 1 %.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< parts of the stage, including the leak
  ValveStage stage;  ///< stage with the leak and a sensor gain of 1
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< losses without a leak and with a sensor gain of 1
  double highest_kpa = 0;    ///< highest measured pressure
  double missing_kpa = 0;    ///< pressure lost at the highest measured pressure
};

/// Returns an empty value in three cases: the fitted gain of the pressure sensor is within the scale errors;
/// a leak reduces the error significantly less than that gain does; or most of the error without leak and
/// gain has another cause.
/// @param scaled  fit of `parts`, which contain no leak, with gain and zero of the sensor.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
