#pragma once
// Logs that begin the moment their command was set: the finger was still where the one before had left it.

#include <optional>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The command before the log began [kPa], if the pressure was not yet at the first command.
/// The measured pressure differs from the first command by 10 % of the command's range or more, and moves at
/// least half of the way to it while the command is constant. No value if the pressure stays away (another
/// zero, another unit). Within the range of the commands the result is the command of the log that is nearest
/// to the measured pressure: the log does not show the response to any other.
///
/// Without a measured pressure the displacement shows it: it moves by a fifth of its range and more while the
/// first command is held. The pressure then was at the lowest command if the displacement rises, otherwise at
/// the highest. Returns nullopt if the first command is that one itself, or lasts for less than 20 samples.
[[nodiscard]] std::optional<double> pressure_before_kpa(const Log& log);

/// The log with one sample more before its first, without readings, at the command `before_kpa`. Times still
/// begin at 0, so all others move by the median interval. A note states this.
[[nodiscard]] Log with_command_before(const Log& log, double before_kpa);

/// Replaces every log that begins as its command was set by with_command_before().
/// @param measured_stay  true: not if its pressure is measured, because a stage of its own begins at that
///                       pressure.
void begin_before_first_command(std::vector<Log>& logs, bool measured_stay);

}  // namespace softgrip::sysid
