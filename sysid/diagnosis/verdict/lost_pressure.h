#pragma once
// Detects that the measured pressure stays below the command by more than scale errors can explain. The cause
// is then a leak or a wrong scale.

#include <cstdint>
#include <optional>

#include "sysid/diagnosis/verdict/measured_valve.h"

namespace softgrip::sysid {

/// Largest difference between the scales of the regulator and of the pressure sensor that is accepted without
/// a leak. According to its data sheet, each of the two has an error of 1 %.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< parts of the valve model, including the leak
  ValveStage stage;  ///< parameters of the valve model with the leak; the sensor gain is 1
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< losses without a leak; the sensor gain is 1
  double highest_kpa = 0;    ///< highest measured pressure
  double missing_kpa = 0;    ///< lost pressure when the measured pressure has its highest value
};

/// Searches for a leak. Returns nullopt in three cases: the fitted gain of the pressure sensor is within the
/// scale errors; a leak reduces the error significantly less than this gain does; or most of the error that
/// remains without leak and gain has another cause.
/// @param scaled  fit of `parts`, which contain no leak, with gain and zero offset of the pressure sensor.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
