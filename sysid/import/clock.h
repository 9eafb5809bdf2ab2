#pragma once
// Clocks that overflow, and files with more than one time column.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// The overflows of a clock that were corrected.
struct Overflow {
  std::size_t count = 0;
  std::size_t first = 0;  ///< index of the first value after an overflow
  double period = 0;      ///< range of the counter, in the clock's unit
};

/// Adds the period of an overflow to all later values of a clock. This is done only if one period explains
/// all backward steps of the clock: that of a counter with 16, 24 or 32 bits, or one day. The counter may
/// count the unit of the clock, a thousandth or a millionth of it. If no period explains all of them, the
/// clock remains unchanged. `unit_s` is the unit of the clock [s].
std::optional<Overflow> continue_overflows(std::vector<double>& clock, double unit_s);

/// Returns the columns that look like a time: dates, times of day, or increasing numbers with the name or
/// the unit of a time.
[[nodiscard]] std::vector<std::size_t> time_columns(const ForeignTable& table);

/// Returns the values of a time column [s]; NaN if a value is missing. Returns nullopt if its unit is
/// unknown.
[[nodiscard]] std::optional<std::vector<double>> seconds_of(const ForeignTable& table, const Mapping& mapping,
                                                            std::size_t column);

/// Returns true if two columns show the same time: their values are equal, or they differ by a constant.
[[nodiscard]] bool same_clock(const ForeignTable& table, const Mapping& mapping, std::size_t a,
                              std::size_t b);

/// Returns the time column for each role. The assignment follows from the names (t_tip belongs to tip). If
/// the names are not conclusive, it follows from the order: each time column is left of its value columns.
/// Returns nullopt if neither is conclusive.
[[nodiscard]] std::optional<std::array<std::size_t, role_count>> times_of_roles(
    const ForeignTable& table, const Mapping& mapping, const std::vector<std::size_t>& times);

}  // namespace softgrip::sysid
