#pragma once
// Finds a measured pressure that stays below the command by more than scale errors explain. The cause is a
// leak or a wrong scale.

#include <cstdint>
#include <optional>

#include "sysid/diagnosis/verdict/measured_valve.h"

namespace softgrip::sysid {

/// Largest difference between two scales that needs no leak as an explanation. A regulator and a pressure
/// sensor have 1 % error each by their data sheets.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< including the leak
  ValveStage stage;  ///< including the leak, with a sensor gain of one
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< losses without leak and gain
  double highest_kpa = 0;    ///< highest measured pressure
  double missing_kpa = 0;    ///< pressure missing at that point
};

/// Returns an empty value in three cases. The fitted gain of the pressure sensor is within the scale errors.
/// A leak explains significantly less of the missing pressure than that gain. Most of the remaining error has
/// another cause.
/// @param scaled  the fit of `parts`, which hold no leak, with gain and zero of the sensor.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
