#pragma once
// Selects the input of the model of the finger: the measured pressure or the command.

#include <cstdint>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// RMS errors in left-out healthy runs [mm] with the measured pressure and with the command as model input.
/// `drive` is the selected input.
struct DriveChoice {
  Drive drive = Drive::measured;
  double by_pressure_mm = 0, by_command_mm = 0;
};

/// Selects the input of the model. The default is the measured pressure. The command is selected if it
/// predicts left-out healthy displacements significantly better than the measured pressure. In addition, the
/// ratio of the squared errors must exceed run_to_run_factor(). The predictions come from a model with play
/// operators and creep. The measured pressure does not determine the displacement if the pressure is measured
/// in the supply pipe of an actuator that a controlled flow moves, or far from the actuator.
/// @param by_pressure, by_command  records of the same healthy logs with each of the two inputs.
[[nodiscard]] DriveChoice chosen_drive(const std::vector<Record>& by_pressure,
                                       const std::vector<Record>& by_command, std::uint64_t seed,
                                       unsigned threads = 0);

}  // namespace softgrip::sysid
