#pragma once
// Finds wrong readings at the beginning of a log, for example the zeros of a sensor that is not ready.

#include <cstddef>
#include <optional>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Wrong readings at the beginning of a log.
struct WrongFirstReadings {
  std::size_t count = 0;  ///< number of wrong readings
  std::size_t samples =
      0;               ///< samples from the beginning to the last wrong reading; some may have no reading
  double last_mm = 0;  ///< last wrong reading
  double next_mm = 0;  ///< reading after it
};

/// Returns the wrong readings at the beginning of the log, or nullopt. A log may begin with a motion, so the
/// first readings are wrong only if they jump to the next readings and nothing explains this jump:
/// - The first readings are at most 19, and at most 5 % of all readings.
/// - They differ from the median of the next 4 readings in the same direction, by more than 6 times the noise
///   and by more than 4 times the spread of the next 4 readings. The smallest of these distances is the jump.
/// - During these readings, neither the command nor the measured pressure has a step between two samples of
///   more than 10 % of its range.
/// - The jump is more than 4 times the largest step between neighbouring readings in the rest of the log, so
///   that the finger cannot move so fast. Or the pressures change by at most 1 % (command) and 10 % (measured
///   pressure) of their range, the next 20 readings differ by less than a quarter of the jump, so that the
///   finger rests, and no reading in the rest of the log is within half of the jump around the first
///   readings.
[[nodiscard]] std::optional<WrongFirstReadings> wrong_first_readings(const Log& log);

}  // namespace softgrip::sysid
