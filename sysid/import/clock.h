#pragma once
// Handles clocks that overflow, and files with more than one time column.

#include <array>
#include <cstddef>
#include <optional>
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

/// Corrects the overflows of a clock: adds the period of each overflow to all later values. The period is
/// that of a counter with 16, 24 or 32 bits, or one day. The counter may count the unit of the clock, or
/// 1/1000 or 1/1,000,000 of this unit. If no period explains all backward steps of the clock, the clock is
/// not changed. @param unit_s  unit of the clock [s].
std::optional<Overflow> continue_overflows(std::vector<double>& clock, double unit_s);

/// Returns the indices of the columns that probably contain times. Such a column contains dates, times of
/// day, or increasing numbers under a name or unit of time.
[[nodiscard]] std::vector<std::size_t> time_columns(const ForeignTable& table);

/// Returns the values of a time column [s]; NaN for a missing value. Returns nullopt if the unit of the
/// column is unknown.
[[nodiscard]] std::optional<std::vector<double>> seconds_of(const ForeignTable& table, const Mapping& mapping,
                                                            std::size_t column);

/// Returns true if two columns show the same time: their values are equal, or they differ by a constant.
[[nodiscard]] bool same_clock(const ForeignTable& table, const Mapping& mapping, std::size_t a,
                              std::size_t b);

/// Returns the time column that belongs to each role. The names of the time columns decide (t_tip belongs to
/// tip). If they are not conclusive, the order of the columns decides: each time column is left of its value
/// columns. Returns nullopt if neither the names nor the order are conclusive.
[[nodiscard]] std::optional<std::array<std::size_t, role_count>> times_of_roles(
    const ForeignTable& table, const Mapping& mapping, const std::vector<std::size_t>& times);

}  // namespace softgrip::sysid
