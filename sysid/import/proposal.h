#pragma once
// A mapping by the names and units of the columns, for somebody to agree to.

#include <string>
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
};

/// Completes `given` by what the columns are called, what their units are and, where two would do, which
/// comes first. Roles that a log may do without are added only where `optional_too`. A column that is given
/// to one role is offered to no other.
[[nodiscard]] Proposal propose(const ForeignTable& table, const Mapping& given, bool optional_too);

/// The unit of a mapped column: the mapping's, the row of units', or its name's; as written, empty: none.
[[nodiscard]] std::string unit_text(const ForeignTable& table, const ColumnMapping& column,
                                    Quantity quantity);

/// One line per column: its number, its name, its unit, its values, and what it is taken for.
[[nodiscard]] std::string mapping_table(const ForeignTable& table, const Mapping& mapping);

}  // namespace softgrip::sysid
