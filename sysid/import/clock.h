#pragma once
// Corrects clocks that overflow, and assigns the time columns of a file that has more than one time column.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Corrected overflows of a clock.
struct Overflow {
  std::size_t count = 0;
  std::size_t first = 0;  ///< index of the first value after the first overflow
  double period = 0;      ///< range of the counter, in the unit of the clock
};

inline constexpr double hour_s = 3600;
inline constexpr double day_s = 86400;

/// Returns true if a value of the clock is less than the value before it. Missing values are ignored.
[[nodiscard]] bool goes_back(const std::vector<double>& clock);

/// Corrects the overflows of a clock: adds the period of each overflow to all later values. The first of
/// `periods` that explains all backward steps of the clock is used. If no period explains them, the clock is
/// not changed.
/// @param periods  possible periods, in the unit of the clock.
std::optional<Overflow> continue_overflows(std::vector<double>& clock, std::span<const double> periods);

/// Corrects the overflows of a clock of numbers. Possible periods are the range of a counter with 16, 24 or
/// 32 bits, and one day. One count of the counter is the unit of the clock, 1/1000 of this unit or
/// 1/1,000,000 of this unit.
/// @param unit_s  unit of the clock [s].
std::optional<Overflow> continue_overflows(std::vector<double>& clock, double unit_s);

/// Returns the note about the corrected overflows of the clock in column `column` of the table.
/// @param row  row of the table with the first value after the first overflow.
[[nodiscard]] std::string about_overflow(const ForeignTable& table, std::size_t column,
                                         const Overflow& overflow, std::size_t row);

/// Returns the indices of the columns that probably contain times. Such a column contains dates, times of
/// day, or increasing numbers. A column of increasing numbers is included only if its name or its unit is
/// that of a time. At least two steps must increase, and at least 90 % of the steps that are not 0.
[[nodiscard]] std::vector<std::size_t> time_columns(const ForeignTable& table);

/// Returns the values of a time column [s]; NaN for a missing value. Overflows are corrected. If the mapping
/// uses the column as a time and states a scale, the scale replaces the unit of the column. Returns nullopt
/// if the unit of the column is unknown.
/// @param overflow  if not null: receives the corrected overflows; nullopt if there are none.
[[nodiscard]] std::optional<std::vector<double>> seconds_of(const ForeignTable& table, const Mapping& mapping,
                                                            std::size_t column,
                                                            std::optional<Overflow>* overflow = nullptr);

/// Returns true if two columns contain the times of the same clock: their values are equal, or the clocks
/// have different origins. Different origins are assumed if the difference is constant and larger than the
/// duration of the recording.
[[nodiscard]] bool same_clock(const ForeignTable& table, const Mapping& mapping, std::size_t a,
                              std::size_t b);

/// Returns the time column of each role. A time column belongs to the role that its name contains: "t_tip"
/// belongs to the role of "tip". If the names do not determine the roles, the order of the columns does: each
/// time column is to the left of its value columns. Returns nullopt if neither the names nor the order
/// determine the roles.
[[nodiscard]] std::optional<std::array<std::size_t, role_count>> times_of_roles(
    const ForeignTable& table, const Mapping& mapping, const std::vector<std::size_t>& times);

}  // namespace softgrip::sysid
