#pragma once
// Selects the input of the finger: its measured pressure or the command.

#include <cstdint>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// RMS error in left-out healthy runs [mm], and the signal that predicts them better.
struct DriveChoice {
  Drive drive = Drive::measured;
  double by_pressure_mm = 0, by_command_mm = 0;
};

/// Selects the command if it predicts left-out healthy displacements significantly better than the measured
/// pressure, and by more than two healthy runs may differ (run_to_run_factor()). Both drive play operators
/// and creep. A measured pressure does not determine the displacement if a flow moves the actuator, or if the
/// pressure sensor is far from it.
/// @param by_pressure, by_command  records of the same healthy logs.
[[nodiscard]] DriveChoice chosen_drive(const std::vector<Record>& by_pressure,
                                       const std::vector<Record>& by_command, std::uint64_t seed,
                                       unsigned threads = 0);

}  // namespace softgrip::sysid
