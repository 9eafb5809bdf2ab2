#pragma once
// Several fingers in the columns of one table, and codes that stand where a sensor read nothing.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// "P1_left (kPa)" is p, 1, left, kpa.
[[nodiscard]] std::vector<std::string> tokens_of(std::string_view name);

/// The fingers that the columns' names tell apart ("left_tip_mm", "right_tip_mm"), in the order of the
/// columns; fewer than two: there is one finger.
[[nodiscard]] std::vector<std::string> fingers_of(const ForeignTable& table);

/// The finger of a column among these; empty: the column belongs to all.
[[nodiscard]] std::string finger_of(const TableColumn& column, const std::vector<std::string>& fingers);

/// Values that are codes, not readings: 999, -9999 and the like, or a value that occurs three times, each far
/// outside of all other values.
[[nodiscard]] std::vector<double> sensor_codes(const TableColumn& column);

}  // namespace softgrip::sysid
