#pragma once
// Which signal drives the finger: its measured pressure, or the command.

#include <cstdint>

#include "sysid/changes/base.h"

namespace softgrip::sysid {

/// Whether the command predicts left-out healthy displacements better than the measured pressure does, by the
/// rule for any two hypotheses. A measured pressure does not determine the displacement where a flow moves
/// the actuator, or where the gauge is far from it.
/// @param by_command, by_pressure  bases of the displacement, fitted to the same healthy logs.
[[nodiscard]] bool command_predicts_better(const Base& by_command, const Base& by_pressure,
                                           std::uint64_t seed);

}  // namespace softgrip::sysid
