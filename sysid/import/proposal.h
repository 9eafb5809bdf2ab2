#pragma once
// A mapping by the names and units of the columns, for somebody to agree to.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

struct Proposal {
  Mapping mapping;  ///< what was given, completed
  /// Roles that were added to what was given.
  std::vector<Role> guessed;
  /// What a log needs and no column offers: "a time: --time COLUMN, or --rate-hz R".
  std::vector<std::string> missing;
  /// Choices that only the user can make: "the columns are of 2 fingers", and the option that makes it.
  struct Question {
    std::string text;
    std::string hint;
  };
  std::vector<Question> questions;
  std::vector<std::string> warnings;  ///< what was taken for a code
};

/// How well a column would do for a role by its name and unit; 0: not at all.
[[nodiscard]] int fitness_for(const TableColumn& column, Role role);
/// True if a part of the name is a word of the role.
[[nodiscard]] bool names_role(std::string_view name, Role role);
/// The unit of numbers that count from 1970, by their size; empty: they do not.
[[nodiscard]] std::string epoch_unit(const TableColumn& column);

/// Completes `given` by what the columns are called, what their units are and, where two would do, which
/// comes first. Roles that a log may do without are added only where `optional_too`. A column that is given
/// to one role is offered to no other. Of several fingers only the columns of the mapping's channel are
/// offered. Times that differ are proposed each for its own columns, or are a question.
[[nodiscard]] Proposal propose(const ForeignTable& table, const Mapping& given, bool optional_too);

/// The unit of a mapped column: the mapping's, the row of units', or its name's; as written, empty: none.
[[nodiscard]] std::string unit_text(const ForeignTable& table, const ColumnMapping& column,
                                    Quantity quantity);

/// One line per column: its number, its name, its unit, its values, and what it is taken for.
[[nodiscard]] std::string mapping_table(const ForeignTable& table, const Mapping& mapping);

}  // namespace softgrip::sysid
