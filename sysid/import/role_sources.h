#pragma once
// Finds the columns of each role in a table, and the conversion of their values to the units of a log.

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "document/problem.h"
#include "sysid/import/mapping.h"
#include "sysid/import/table.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {

/// Conversion of the values of a column. The value in the unit of the log is factor * value + offset.
struct Conversion {
  double factor = 1;
  double offset = 0;

  [[nodiscard]] double operator()(double value) const { return factor * value + offset; }
};

/// Columns of one role. The value in the log is the mean of the converted values of all columns.
struct RoleSource {
  std::vector<std::size_t> columns;
  /// Conversion of each column; empty for several time columns (seconds_of() in clock.h converts them).
  std::vector<Conversion> conversions;
};

/// Sources of all roles.
struct RoleSources {
  std::array<RoleSource, role_count> of_roles;
  /// Rows with a cell that cannot be read. The list is filled only if the options request that such rows are
  /// skipped.
  std::set<std::size_t> bad_rows;
  model::OutputUnit output_unit = model::OutputUnit::mm;

  /// Returns true if a role uses the column.
  [[nodiscard]] bool uses(std::size_t column) const;
};

/// Returns the columns and the conversion of each role, as the mapping defines them. A required role without
/// a column, an unknown column, a column with bad cells and a missing unit are problems.
[[nodiscard]] RoleSources resolve_sources(const ForeignTable& table, const Mapping& mapping,
                                          document::Problems& problems);

/// Returns the unit of the angle if the options contain --scale and --unit displacement=deg or rad, otherwise
/// nullopt.
[[nodiscard]] std::optional<Unit> angle_of_scale(const RoleSpec& spec, const ColumnMapping& mapped);

}  // namespace softgrip::sysid
