#pragma once
// Proposes a mapping, derived from the names and units of the columns. The user has to confirm the proposal.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

struct Proposal {
  Mapping mapping;  ///< mapping of the user, completed with the proposed columns
  /// Roles whose column was proposed.
  std::vector<Role> guessed;
  /// Required roles without a column. Each element also names the option that states the column: "a time:
  /// --time COLUMN, or --rate-hz R".
  std::vector<std::string> missing;
  /// A choice that the user must make ("the columns belong to 2 fingers"), and the option that states the
  /// choice.
  struct Question {
    std::string text;
    std::string hint;
  };
  std::vector<Question> questions;
  /// Notes on the numbers of values that count as missing because the given mapping states their codes, and
  /// on columns that are not proposed because they have no value.
  std::vector<std::string> notes;
  /// Warnings about values that were interpreted as codes for missing values, and about the choice of the
  /// displacement among several columns.
  std::vector<std::string> warnings;
};

/// Returns the unit of a column of times since 1970. The magnitude of the first value determines this unit.
/// Returns "" for a column of other values.
[[nodiscard]] std::string epoch_unit(const TableColumn& column);

/// Completes the mapping `given` from the names and units of the columns. If two columns fit a role equally
/// well, the first one is used. A column without a value is not proposed. A displacement that does not move
/// is used only if no other column that fits moves. Optional roles are assigned only if `optional_too` is
/// true. A column gets at most one role. If the table has several fingers, only the columns of the mapping's
/// channel are considered. If the time columns contain different times, each time column is assigned to its
/// value columns. If this assignment is not clear, the proposal contains a question.
[[nodiscard]] Proposal propose(const ForeignTable& table, const Mapping& given, bool optional_too);

/// Returns the unit of a mapped column as text. The first of these sources is used: the mapping, the row of
/// units, the name of the column. Returns "" if no source states a unit.
[[nodiscard]] std::string unit_of(const TableColumn& column, const ColumnMapping& mapped, Quantity quantity);
/// Returns the units of all columns of a role as text, each unit once: "psi, kPa". Returns "" if no column
/// has a unit.
[[nodiscard]] std::string unit_text(const ForeignTable& table, const ColumnMapping& column,
                                    Quantity quantity);

/// Returns the mapping as a table with one line per column: number, name, some values, and the role with its
/// unit.
[[nodiscard]] std::string mapping_table(const ForeignTable& table, const Mapping& mapping);

}  // namespace softgrip::sysid
