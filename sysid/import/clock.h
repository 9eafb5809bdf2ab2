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

/// A clock that has been continued where it overflowed.
struct Overflow {
  std::size_t count = 0;
  std::size_t first = 0;  ///< index of the first value behind an overflow
  double period = 0;      ///< in the clock's unit
};

/// Continues a clock where each step back is surely an overflow: of 16, 24 or 32 bits in its unit or a
/// thousandth or millionth of it, or of a day. A step back of another kind changes nothing. `unit_s`: the
/// clock's unit.
std::optional<Overflow> continue_overflows(std::vector<double>& clock, double unit_s);

/// The columns that look like a time: dates, times of day, or numbers that rise and have the name or the unit
/// of a time.
[[nodiscard]] std::vector<std::size_t> time_columns(const ForeignTable& table);

/// The seconds of a time column; NaN where it has none. Nothing if its unit is open.
[[nodiscard]] std::optional<std::vector<double>> seconds_of(const ForeignTable& table, const Mapping& mapping,
                                                            std::size_t column);

/// True if the columns show the same time: equal, or two clocks that differ by a constant.
[[nodiscard]] bool same_clock(const ForeignTable& table, const Mapping& mapping, std::size_t a,
                              std::size_t b);

/// The time column of each role's columns, by their names (t_tip, tip) or by their order (each time stands
/// left of its columns). Nothing if neither shows it.
[[nodiscard]] std::optional<std::array<std::size_t, role_count>> times_of_roles(
    const ForeignTable& table, const Mapping& mapping, const std::vector<std::size_t>& times);

}  // namespace softgrip::sysid
