#pragma once
// A measured pressure that stays below the command by more than scales differ: a leak, or a scale after all.

#include <cstdint>
#include <optional>

#include "sysid/diagnosis/verdict/measured_valve.h"

namespace softgrip::sysid {

/// What two scales may differ by and nobody looks for a leak: a regulator and a pressure sensor of 1 % each,
/// as their data sheets have it.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< with the leak
  ValveStage stage;  ///< with it, and a sensor whose gain is one
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< neither leak nor gain
  double highest_kpa = 0;    ///< measured
  double missing_kpa = 0;    ///< there
};

/// Nothing where the gain of the pressure's sensor, fitted in its place, is within what scales differ by,
/// where a leak takes clearly less of what is missing than that gain does, or where most of what is left is
/// something else.
/// @param scaled  the fit of `parts`, which hold no leak, with gain and zero of the sensor.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
