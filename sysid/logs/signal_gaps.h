#pragma once
// Finds ranges of a log in which a measured column contains no information although the command changes.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

// A range without information from a column is a gap only if it exceeds all three of the following limits.

/// Shortest gap [s]. A finger hardly moves in a shorter time.
inline constexpr double shortest_gap_s = 0.5;
/// Shortest gap in usual intervals of the column.
inline constexpr double shortest_gap_intervals = 20;
/// Smallest change of the command in a gap, as a share of the range of the commands in the log.
inline constexpr double least_gap_change = 0.02;

/// A gap in a measured column.
struct SignalGap {
  /// Last sample before the gap that has a value, or the first sample of the log if there is no such sample.
  std::size_t first = 0;
  /// First sample after the gap that has a value, or the last sample of the log if there is no such sample.
  std::size_t last = 0;
  double length_s = 0;    ///< time from `first` to `last`
  double change_kpa = 0;  ///< difference between the largest and the smallest command from `first` to `last`
};

/// Returns the longest gap in the measured pressure, or nullopt if there is none. The usual interval is the
/// median interval between two measured pressures, so a slow sensor has no gaps.
[[nodiscard]] std::optional<SignalGap> pressure_gap(const Log& log);

/// Returns a sentence about a gap in the measured pressure, without a full stop.
[[nodiscard]] std::string gap_sentence(const Log& log, const SignalGap& gap);

/// Returns the longest range in which a column keeps exactly the same value, although the command changes.
/// Returns nullopt if there is no such range. The range counts from the first change of the command, because
/// a value may be constant before this change. The usual interval is the median number of successive equal
/// values. The largest and the smallest value of the column are not considered, because a sensor or a supply
/// that saturates causes long ranges of these values.
/// @param values  a column of the log; NaN is a missing value.
[[nodiscard]] std::optional<SignalGap> frozen_range(const Log& log, const std::vector<double>& values);

}  // namespace softgrip::sysid
