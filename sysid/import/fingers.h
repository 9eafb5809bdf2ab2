#pragma once
// Detects that the columns of one table belong to several fingers.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Splits a name into lower-case words and numbers: "P1_left (kPa)" gives p, 1, left, kpa.
[[nodiscard]] std::vector<std::string> tokens_of(std::string_view name);

/// Largest number of fingers of a rig. A column with more different values contains readings, not names of
/// fingers.
inline constexpr std::size_t most_fingers = 16;

/// Returns true if the cells of a column with this name identify the finger of each row. Such names are
/// "channel", "Finger ID" and "run.actuator".
[[nodiscard]] bool names_channel(std::string_view name);

/// Returns the fingers that the column names distinguish ("left_tip_mm", "right_tip_mm"), in the order of the
/// columns. If the result has fewer than two elements, the table belongs to one finger.
[[nodiscard]] std::vector<std::string> fingers_of(const ForeignTable& table);

/// Returns the name of the finger to which a column belongs; empty if the column belongs to all fingers.
[[nodiscard]] std::string finger_of(const TableColumn& column, const std::vector<std::string>& fingers);

/// Returns the names of the columns that belong to none of the fingers, but whose names differ from the name
/// of a finger's column only in the number: "pd3_psi" if the fingers are 1 and 2 and "pd1_psi" exists. Such a
/// column belongs to a finger without a displacement.
[[nodiscard]] std::vector<std::string> columns_of_no_finger(const ForeignTable& table,
                                                            const std::vector<std::string>& fingers);

}  // namespace softgrip::sysid
