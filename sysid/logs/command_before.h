#pragma once
// Handles logs whose first sample is the moment at which the command changes to its first value. At this
// moment, the finger is still at the position of the previous command.

#include <optional>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns the command before the beginning of the log [kPa], or nullopt if the pressure was already at the
/// first command. The first command counts as held although a single sample may have another command.
/// A wrong command of a single sample (command_range.h) does not count as a command of the log.
///
/// If the log contains a measured pressure, two conditions must be met. At the beginning, the pressure
/// differs from the first command by more than 10 % of the range of the commands. While the first command is
/// held, the pressure covers more than half of this difference. If the pressure does not approach the
/// command, pressure and command probably have different zeros or units, and the result is nullopt. If the
/// initial pressure is within the range of the commands, the result is the nearest command of the log,
/// because the log does not show the response to other commands. Otherwise the result is the initial
/// pressure.
///
/// If the log contains no measured pressure, the displacement indicates a previous command if it moves by
/// more than 20 % of its range while the first command is held. Motion and range are computed from medians of
/// five readings, so that an outlier has no effect. The result is the lowest command of the log
/// if the displacement rises, and the highest command if it falls. The result is nullopt if the first command
/// differs from this lowest or highest command by at most 10 % of the range of the commands, if it is held
/// for less than 20 samples, or if it never changes.
[[nodiscard]] std::optional<double> pressure_before_kpa(const Log& log);

/// Returns the log with an additional first sample that has the command `before_kpa` and no reading. The
/// additional sample has the time of the former first sample, and all other samples are delayed by the median
/// interval. A note in the log states that the sample was added.
[[nodiscard]] Log with_command_before(const Log& log, double before_kpa);

/// Applies with_command_before() to each log for which pressure_before_kpa() returns a value.
/// @param measured_stay  true: logs with a measured pressure remain unchanged, because a separate model of
/// the pressure begins at the measured pressure.
void begin_before_first_command(std::vector<Log>& logs, bool measured_stay);

}  // namespace softgrip::sysid
