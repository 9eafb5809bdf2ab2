#pragma once
// Logs that begin the moment their command was set: the finger was still where the one before had left it.

#include <optional>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Where the pressure stood when the log began [kPa], if that was not where its first command asks it to be:
/// the measured pressure lies a tenth of the command's range and more away from it and comes at least half of
/// the way while the command stands. Nothing without measured pressure, and of a pressure that stays away
/// (another zero, another unit).
[[nodiscard]] std::optional<double> pressure_before_kpa(const Log& log);

/// The log with one sample more before its first, without readings, at the command `before_kpa`. Times still
/// begin at 0, so all others move by the median interval. A note tells it.
[[nodiscard]] Log with_command_before(const Log& log, double before_kpa);

}  // namespace softgrip::sysid
