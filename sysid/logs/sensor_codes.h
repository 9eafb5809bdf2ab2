#pragma once
// Numbers that a sensor writes in place of a reading.

#include <span>
#include <vector>

namespace softgrip::sysid {

/// Values that are codes, not readings: 999, -9999 and the like, or a value that occurs three times, each far
/// outside of all other values; ascending. Values that are not finite do not count.
[[nodiscard]] std::vector<double> sensor_codes(std::span<const double> values);

}  // namespace softgrip::sysid
