#pragma once
// Several fingers in the columns of one table.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// "P1_left (kPa)" is p, 1, left, kpa.
[[nodiscard]] std::vector<std::string> tokens_of(std::string_view name);

/// More fingers than a rig has are readings.
inline constexpr std::size_t most_fingers = 16;

/// True for a column whose cells say of which finger a row is: "channel", "Finger ID", "run.actuator".
[[nodiscard]] bool names_channel(std::string_view name);

/// The fingers that the columns' names tell apart ("left_tip_mm", "right_tip_mm"), in the order of the
/// columns; fewer than two: there is one finger.
[[nodiscard]] std::vector<std::string> fingers_of(const ForeignTable& table);

/// The finger of a column among these; empty: the column belongs to all.
[[nodiscard]] std::string finger_of(const TableColumn& column, const std::vector<std::string>& fingers);

}  // namespace softgrip::sysid
