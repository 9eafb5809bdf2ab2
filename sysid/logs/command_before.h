#pragma once
// Logs that begin when their first command is set: the finger is still at the position of the previous
// command.

#include <optional>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns the command before the log began [kPa] if the pressure was not yet at the first command, otherwise
/// nullopt. The condition is: the measured pressure differs from the first command by at least 10 % of the
/// range of the commands, and covers more than half of this difference while the command is constant. A
/// pressure that does not approach the command has another zero or unit, so the result is nullopt. If the
/// measured pressure is within the range of the commands, the result is the nearest command of the log,
/// because the log does not show the response to any other.
///
/// Without a measured pressure, the displacement is used: it must move by more than 20 % of its range while
/// the first command is held. The previous command is the lowest one if the displacement rises, otherwise the
/// highest. Returns nullopt if the first command is itself this extreme, or if it lasts for less than 20
/// samples.
[[nodiscard]] std::optional<double> pressure_before_kpa(const Log& log);

/// Returns the log with an additional first sample at the command `before_kpa`, without readings. Times still
/// begin at 0, so all other samples are shifted by the median interval. A note states this.
[[nodiscard]] Log with_command_before(const Log& log, double before_kpa);

/// Replaces each log for which pressure_before_kpa() has a value by with_command_before().
/// @param measured_stay  true: logs with a measured pressure remain unchanged, because a separate model stage
/// begins
///                       at that pressure.
void begin_before_first_command(std::vector<Log>& logs, bool measured_stay);

}  // namespace softgrip::sysid
