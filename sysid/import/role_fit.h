#pragma once
// States how well a column of an external file fits a role. The name and the unit of the column determine the
// result.

#include <string_view>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Returns a score that states how well a column fits a role, from the column's name and unit. 0: the column
/// cannot have the role.
[[nodiscard]] int fitness_for(const TableColumn& column, Role role);
/// Returns true if a part of the name is a word that identifies the role.
[[nodiscard]] bool names_role(std::string_view name, Role role);

}  // namespace softgrip::sysid
