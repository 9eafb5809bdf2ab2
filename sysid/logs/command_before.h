#pragma once
// Handles logs that begin at the moment when their first command is set, while the finger is still at the
// position of the previous command.

#include <optional>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns the command before the beginning of the log [kPa], or nullopt if the pressure was already at the
/// first command. With a measured pressure, there are two conditions. The pressure at the beginning differs
/// from the first command by at least 10 % of the range of the commands, and it covers more than half of this
/// difference while the command is constant. If the pressure does not approach the command, the two differ in
/// zero or unit, and the result is nullopt. If the pressure at the beginning is within the range of the
/// commands, the result is the nearest command of the log, because the response to other commands is not
/// known from the log.
///
/// Without a measured pressure, the displacement is used. It must move by more than 20 % of its range while
/// the first command is held. The previous command is then the lowest command of the log if the displacement
/// rises, and the highest if it falls. Returns nullopt if the first command is already this command, or if it
/// lasts for less than 20 samples.
[[nodiscard]] std::optional<double> pressure_before_kpa(const Log& log);

/// Returns the log with an additional first sample that has the command `before_kpa` and no readings. The
/// times begin at 0 as before, so all other samples are delayed by the median interval. A note states the
/// change.
[[nodiscard]] Log with_command_before(const Log& log, double before_kpa);

/// Adds such a first sample to each log for which pressure_before_kpa() returns a value.
/// @param measured_stay  true: logs with a measured pressure remain unchanged, because a separate model of
/// the pressure begins at the measured value.
void begin_before_first_command(std::vector<Log>& logs, bool measured_stay);

}  // namespace softgrip::sysid
