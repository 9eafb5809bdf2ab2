#pragma once
// Detects error codes that a sensor writes instead of a reading.

#include <cstdint>
#include <span>
#include <vector>

namespace softgrip::sysid {

/// Smallest distance of a value from all other values, as a multiple of their range, for which the value
/// counts as far outside of them.
inline constexpr double far_outside = 3;

/// Kinds of codes that sensor_codes() detects.
enum class CodeKinds : std::uint8_t {
  any,     ///< typical codes, and values that occur at least three times
  typical  ///< only typical codes
};

/// Returns the values that are error codes instead of readings, in ascending order. An error code is far
/// outside the range of all other values. In addition, it is a typical code (999, -9999 and similar numbers),
/// or it occurs at least three times and `kinds` is CodeKinds::any. A value that a motion reaches through
/// intermediate values is no error code: next to such a value there is a reading that is nearer to it than to
/// the range of the other values. Values that are not finite are ignored. Returns no codes for fewer than 20
/// finite values, or if more than half of the values seem to be codes.
[[nodiscard]] std::vector<double> sensor_codes(std::span<const double> values,
                                               CodeKinds kinds = CodeKinds::any);

}  // namespace softgrip::sysid
