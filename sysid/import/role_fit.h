#pragma once
// States how well a column of an external file fits a role. The name and the unit of the column determine the
// result.

#include <optional>
#include <string>
#include <string_view>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {

/// Returns the unit that a column states: its unit, or the unit at the end of its name; "" if there is none.
/// @param quantity  quantity to which a unit in the name must belong; not set: any quantity.
[[nodiscard]] std::string stated_unit(const TableColumn& column, std::optional<Quantity> quantity = {});
/// Returns a score that states how well a column fits a role, from the column's name and unit. 0: the column
/// cannot have the role.
[[nodiscard]] int fitness_for(const TableColumn& column, Role role);
/// Returns true if the name states that the values are derived from a quantity, for example an error, a
/// difference, a rate or a standard deviation: "p_error_kpa". The import never proposes such a column.
[[nodiscard]] bool names_derived_value(std::string_view name);
/// Returns true if a part of the name is a word that identifies the role.
[[nodiscard]] bool names_role(std::string_view name, Role role);

}  // namespace softgrip::sysid
