#pragma once
// A mapping that is derived from the names and units of the columns. The user confirms it.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

struct Proposal {
  Mapping mapping;  ///< the given mapping with the proposed columns
  /// Roles that were added to the given mapping.
  std::vector<Role> guessed;
  /// Required roles for which no column was found: "a time: --time COLUMN, or --rate-hz R".
  std::vector<std::string> missing;
  /// A choice that only the user can make ("the columns belong to 2 fingers"), and the option for it.
  struct Question {
    std::string text;
    std::string hint;
  };
  std::vector<Question> questions;
  std::vector<std::string> warnings;  ///< values that were taken as codes for missing values
};

/// Returns a score for a column in a role, based on its name and unit. 0: the column cannot have the role.
[[nodiscard]] int fitness_for(const TableColumn& column, Role role);
/// Returns true if a part of the name is a word of the role.
[[nodiscard]] bool names_role(std::string_view name, Role role);
/// Returns the unit of times since 1970, determined from their size; empty for other numbers.
[[nodiscard]] std::string epoch_unit(const TableColumn& column);

/// Completes `given` by the names and units of the columns. Of two equally suitable columns, the first is
/// taken. Optional roles are added only if `optional_too`. A column has at most one role. If the table has
/// several fingers, only the columns of the mapping's channel are considered. If time columns differ, each is
/// proposed for its own columns, or the user must choose.
[[nodiscard]] Proposal propose(const ForeignTable& table, const Mapping& given, bool optional_too);

/// Returns the unit of a mapped column as written: from the mapping, otherwise from the row of units,
/// otherwise from the name of the column; empty if there is none.
[[nodiscard]] std::string unit_text(const ForeignTable& table, const ColumnMapping& column,
                                    Quantity quantity);

/// Returns a table with one line per column: number, name, unit, some values, and the role.
[[nodiscard]] std::string mapping_table(const ForeignTable& table, const Mapping& mapping);

}  // namespace softgrip::sysid
