#pragma once
// Selects the input of the model of the finger: the measured pressure or the command.

#include <cstdint>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// RMS error in left-out healthy runs [mm] with each of the two inputs, and the input that predicts them
/// better.
struct DriveChoice {
  Drive drive = Drive::measured;
  double by_pressure_mm = 0, by_command_mm = 0;
};

/// Selects the command if it predicts left-out healthy displacements significantly better than the measured
/// pressure, and if the errors differ by more than those of two healthy runs may (run_to_run_factor()). The
/// predictions come from play operators and creep with the respective input. A measured pressure does not
/// determine the displacement if a flow moves the actuator, or if the pressure sensor is far from the
/// actuator.
/// @param by_pressure, by_command  records of the same healthy logs with each of the two inputs.
[[nodiscard]] DriveChoice chosen_drive(const std::vector<Record>& by_pressure,
                                       const std::vector<Record>& by_command, std::uint64_t seed,
                                       unsigned threads = 0);

}  // namespace softgrip::sysid
