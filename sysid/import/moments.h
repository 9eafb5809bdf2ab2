#pragma once
// Dates and times of day as people and loggers write them.

#include <optional>
#include <string_view>

#include "base/time.h"

namespace softgrip::sysid {

/// A point in time, on a scale of which only differences matter.
struct Moment {
  Nanoseconds time = 0;         ///< since 1970 in UTC, or since midnight
  bool dated = false;           ///< false: a time of day alone
  bool short_clock = false;     ///< two fields ("12:34"), read as minutes and seconds
  bool surely_minutes = false;  ///< they cannot be hours and minutes
};

/// ISO 8601 (2024-05-31T12:00:00.25+02:00, blank for T, decimal comma too), 31.05.2024 12:00:00, 2024/05/31
/// 12:00:00, 31-May-2024 12:00:00, May 31, 2024 12:00:00, and a time of day alone (12:00:00.25, 12:00:00:250,
/// 12:00:00 PM). Two fields alone are minutes and seconds (00:59.5). 05/31/2024 is none: which is the month
/// is anybody's guess.
[[nodiscard]] std::optional<Moment> moment_of(std::string_view text);

}  // namespace softgrip::sysid
