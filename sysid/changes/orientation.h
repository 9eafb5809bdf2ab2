#pragma once
// Mirrors logs whose pressures are negative or whose readings fall. The causes act only on a pressure above
// atmospheric pressure and on a reading that rises with it: a stop, for example, limits the largest reading.
// The change diagnosis of a vacuum actuator, or of a sensor that is mounted in reverse, therefore evaluates
// the mirrored logs.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Factors of the pressures and of the readings: 1 (unchanged) or -1 (mirrored).
struct Orientation {
  double pressure = 1;
  double reading = 1;

  [[nodiscard]] bool is_mirrored() const noexcept { return pressure < 0 || reading < 0; }
};

/// Returns the orientation in which the pressure of largest magnitude is positive, and in which the readings
/// rise with the command. The readings are mirrored only if they are correlated with the command within the
/// logs. The logs may have different zeros.
[[nodiscard]] Orientation orientation_of(const std::vector<Log>& logs);
/// Returns the logs with mirrored pressures and readings.
[[nodiscard]] std::vector<Log> oriented(std::vector<Log> logs, const Orientation& orientation);
/// Returns a sentence for the user that states which columns are multiplied by -1; "" if no column is.
[[nodiscard]] std::string sentence_of(const Orientation& orientation);

}  // namespace softgrip::sysid
