#pragma once
// Derives a mapping from the names and units of the columns. The user confirms the mapping.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

struct Proposal {
  Mapping mapping;  ///< the given mapping with the proposed columns
  /// Roles that the proposal added to the given mapping.
  std::vector<Role> guessed;
  /// Required roles for which no column was found, each with the option that states it: "a time: --time
  /// COLUMN, or --rate-hz R".
  std::vector<std::string> missing;
  /// A choice that only the user can make ("the columns belong to 2 fingers"), and the option for it.
  struct Question {
    std::string text;
    std::string hint;
  };
  std::vector<Question> questions;
  std::vector<std::string> warnings;  ///< values that were taken as codes for missing values
};

/// Returns a score for the suitability of a column for a role, based on its name and unit. 0: the column
/// cannot have the role.
[[nodiscard]] int fitness_for(const TableColumn& column, Role role);
/// Returns true if a part of the name is a word that identifies the role.
[[nodiscard]] bool names_role(std::string_view name, Role role);
/// Returns the unit of a column of times since 1970, determined from the size of the values. Returns "" for
/// other columns.
[[nodiscard]] std::string epoch_unit(const TableColumn& column);

/// Completes the mapping `given` from the names and units of the columns. Of two equally suitable columns,
/// the first is used. Optional roles are added only if `optional_too` is set. A column gets at most one role.
/// If the table has several fingers, only the columns of the mapping's channel are considered. If the table
/// has time columns with different times, each is assigned to its own value columns. If this assignment is
/// not clear, the proposal contains a question.
[[nodiscard]] Proposal propose(const ForeignTable& table, const Mapping& given, bool optional_too);

/// Returns the unit of a mapped column as a text: the unit in the mapping, otherwise that in the row of
/// units, otherwise that in the name of the column. Returns "" if there is none.
[[nodiscard]] std::string unit_text(const ForeignTable& table, const ColumnMapping& column,
                                    Quantity quantity);

/// Returns a table with one line per column: number, name, unit, some values, and the role.
[[nodiscard]] std::string mapping_table(const ForeignTable& table, const Mapping& mapping);

}  // namespace softgrip::sysid
