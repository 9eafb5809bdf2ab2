#pragma once
// Assigns the columns of an external file to the columns of a log and converts their units.
// Writes and reads a mapping as YAML. Each imported log gets such a mapping file, and `softgrip import --map`
// reads this file.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/enum_table.h"
#include "document/problem.h"
#include "sysid/import/units.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Role of a column: the quantity in the log to which the column supplies the values.
enum class Role : std::uint8_t { time, command, pressure, displacement, temperature, supply };
inline constexpr std::size_t role_count = 6;

/// Names, quantity and unit of a role.
struct RoleSpec {
  Role role;
  std::string_view word;  ///< name of the role in options and mapping files
  Quantity quantity;
  /// Unit in the log, as written in options; for displacement, deg is possible instead of mm.
  std::string_view unit;
  std::vector<double> Log::*values;
};
inline constexpr std::array<RoleSpec, role_count> roles{{
    {Role::time, "time", Quantity::time, "s", &Log::time_s},
    {Role::command, "command", Quantity::pressure, "kPa", &Log::pressure_command_kpa},
    {Role::pressure, "pressure", Quantity::pressure, "kPa", &Log::pressure_kpa},
    {Role::displacement, "displacement", Quantity::displacement, "mm", &Log::displacement_mm},
    {Role::temperature, "temperature", Quantity::temperature, "C", &Log::temperature_c},
    {Role::supply, "supply", Quantity::pressure, "kPa", &Log::supply_kpa},
}};
static_assert(!is_enumerator<static_cast<Role>(role_count)>(), "a role has no row");
static_assert(
    [] {
      for (std::size_t i = 0; i < role_count; ++i)
        if (roles[i].role != static_cast<Role>(i)) return false;
      return true;
    }(),
    "the rows are not in the order of the roles");
[[nodiscard]] constexpr const RoleSpec& spec_of(Role role) {
  return roles[static_cast<std::size_t>(role)];
}

/// Source of the values of a role. To compute a value of the log, `zero` is subtracted from the value in the
/// column. If `scale` is set, the difference is then multiplied by `scale`. Otherwise, the difference is
/// converted from `unit` to the unit of the log.
struct ColumnMapping {
  /// Names of the columns, or their numbers counted from 1; empty: no column has the role. Several columns
  /// are averaged. Several time columns are not averaged: each time column applies to its own value columns
  /// (times_of_roles() in clock.h).
  std::vector<std::string> columns;
  std::string unit;  ///< unit of the column; empty: the unit that the header of the column states
  /// Factor that converts a value of the column to the unit of the log. If this factor is set, it replaces
  /// the conversion of `unit`. If `unit` is a unit of angle, the product of displacement and `scale` is in
  /// this unit.
  std::optional<double> scale;
  std::optional<double> zero;  ///< value that is subtracted before the conversion, in the unit of the column
  bool zero_first = false;     ///< true: the first value of the column is subtracted from all its values

  [[nodiscard]] bool given() const noexcept { return !columns.empty(); }
  bool operator==(const ColumnMapping&) const = default;
};

/// A number that means a missing value in one column, such as 999.
struct ColumnCode {
  std::string column;  ///< name of the column, or its number counted from 1
  double value = 0;    ///< number in the unit of the column

  bool operator==(const ColumnCode&) const = default;
};

struct Mapping {
  std::array<ColumnMapping, role_count> columns;
  std::optional<double> rate_hz;  ///< sampling rate; used if no column has the role time
  char separator = 0;             ///< character between the columns; 0: detected automatically
  /// Words and numbers that mean a missing value in every column.
  std::vector<std::string> missing;
  /// Numbers that mean a missing value in one column only. In another column, the same number is a value.
  std::vector<ColumnCode> missing_in;
  std::string channel;
  std::string sheet;            ///< name of the sheet of a workbook
  bool skip_bad_lines = false;  ///< true: lines that cannot be read are left out and counted
  double from_s = 0;            ///< start of the log, relative to the first sample of the file [s]
  double to_s = std::numeric_limits<double>::infinity();

  [[nodiscard]] ColumnMapping& operator[](Role role) { return columns[static_cast<std::size_t>(role)]; }
  [[nodiscard]] const ColumnMapping& operator[](Role role) const {
    return columns[static_cast<std::size_t>(role)];
  }
  /// Returns true if the mapping assigns time (or states a sampling rate), displacement, and at least one of
  /// command and pressure.
  [[nodiscard]] bool complete() const;
  bool operator==(const Mapping&) const = default;
};

/// Returns the options of `softgrip import` that give this mapping, quoted for a shell: "--time 'Time (s)'
/// --unit pressure=psi".
[[nodiscard]] std::string options_of(const Mapping& mapping);

/// Returns the separator for a word: "comma", "semicolon", "tab", "space", "bar" or the character itself.
/// Returns 0 for any other word.
[[nodiscard]] char separator_named(std::string_view word);
/// Returns the name of a separator; the inverse of separator_named().
[[nodiscard]] std::string_view word_of_separator(char separator);

/// Data about the imported file. They are written to the mapping file for documentation only.
struct ImportSource {
  std::string file;
  std::string sha256;
  std::string format;
};

/// Returns the mapping as YAML text, which parse_mapping() converts back to the same mapping. The names of
/// the columns must be UTF-8 without control characters. `remarks` are written above the mapping as comments
/// of at most 32 KiB. A comment states the number of remarks that are left out.
[[nodiscard]] std::string mapping_yaml(const Mapping& mapping, const ImportSource& source,
                                       const std::string& software, const std::vector<std::string>& remarks);

/// Parses a mapping. Adds all problems to `problems`, and returns nullopt if there is a problem. `file` is
/// the name of the text in messages.
[[nodiscard]] std::optional<Mapping> parse_mapping(const std::string& file, const std::string& text,
                                                   document::Problems& problems);
/// Reads and parses a mapping file. A problem is added if the file cannot be read.
[[nodiscard]] std::optional<Mapping> read_mapping(const std::string& path, document::Problems& problems);

}  // namespace softgrip::sysid
