#pragma once
// Recognises that the columns of one table belong to several fingers.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Splits a name into lower-case words and numbers: "P1_left (kPa)" gives p, 1, left, kpa.
[[nodiscard]] std::vector<std::string> tokens_of(std::string_view name);

/// Largest number of fingers of a rig. If a column has more than this number of different cells, the cells
/// are readings, not names of fingers.
inline constexpr std::size_t most_fingers = 16;

/// Returns true if the name shows that the cells of a column name the finger of each row: "channel", "Finger
/// ID", "run.actuator".
[[nodiscard]] bool names_channel(std::string_view name);

/// Returns the fingers that the names of the columns distinguish ("left_tip_mm", "right_tip_mm"), in the
/// order of the columns. If fewer than two are returned, the table has one finger.
[[nodiscard]] std::vector<std::string> fingers_of(const ForeignTable& table);

/// Returns the finger of a column; empty if the column belongs to all fingers.
[[nodiscard]] std::string finger_of(const TableColumn& column, const std::vector<std::string>& fingers);

}  // namespace softgrip::sysid
