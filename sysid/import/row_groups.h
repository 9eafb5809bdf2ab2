#pragma once
// Detects that the rows of a table belong to several runs or devices.

#include <optional>
#include <string>
#include <vector>

#include "sysid/import/role_sources.h"
#include "sysid/import/samples.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// A column of numbers whose values separate the rows of several runs or devices.
struct RowGroups {
  std::string column;          ///< name of the column, or its number
  std::vector<double> values;  ///< different values, in the order of their first rows
  /// True: the times of all rows together repeat or decrease, but the times of the rows of each value
  /// increase. False: the times increase, but the readings of consecutive rows differ more than the readings
  /// of consecutive rows of one value.
  bool by_times = false;
};

/// Returns the first unused column that separates the rows, or nullopt if there is no such column. The column
/// must have 2 to most_fingers different values. If the times only repeat or increase, the name of the column
/// must state an identifier (names_group()), or the readings must differ less within the groups.
/// @param samples  all samples of the table in the order of their rows, with one time column.
[[nodiscard]] std::optional<RowGroups> row_groups(const ForeignTable& table, const RoleSources& sources,
                                                  const ForeignSamples& samples);

/// Returns true if a column with this name identifies the run or the device of each row: "id", "Run no",
/// "sensor_id2".
[[nodiscard]] bool names_group(std::string_view name);

/// Returns sentences that state the column, its values and how to import the rows of one value.
[[nodiscard]] std::string about_groups(const ForeignTable& table, const RowGroups& groups);

}  // namespace softgrip::sysid
