#pragma once
// Which columns of a foreign file are which of a log, and how to come to its units.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/units.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// What a column of a log is for.
enum class Role : std::uint8_t { time, command, pressure, displacement, temperature, supply };
inline constexpr std::size_t role_count = 6;

/// A role's words.
struct RoleSpec {
  Role role;
  std::string_view word;  ///< of options and mapping files
  Quantity quantity;
  std::string_view unit;  ///< of the log, as options say it; a displacement may be in deg
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
[[nodiscard]] constexpr const RoleSpec& spec_of(Role role) {
  return roles[static_cast<std::size_t>(role)];
}

/// Where a role's values come from: (value - zero) in `unit`, or times `scale`.
struct ColumnMapping {
  std::vector<std::string>
      columns;       ///< names, or numbers from 1; several are averaged, but each of several times holds for
                     ///< its own columns (clock.h); empty: the role is not there
  std::string unit;  ///< empty: what the column itself says
  std::optional<double> scale;  ///< log units per unit of the column, in place of a unit's; of a
                                ///< displacement, units of an angle where `unit` is one
  std::optional<double> zero;   ///< subtracted before, in the column's unit
  bool zero_first = false;      ///< the first value is subtracted

  [[nodiscard]] bool given() const noexcept { return !columns.empty(); }
  bool operator==(const ColumnMapping&) const = default;
};

struct Mapping {
  std::array<ColumnMapping, role_count> columns;
  std::optional<double> rate_hz;  ///< samples per second of a file without times
  char separator = 0;             ///< 0: found
  std::vector<std::string> missing;
  std::string channel;
  std::string sheet;            ///< of a workbook
  bool skip_bad_lines = false;  ///< lines that cannot be read are left out and counted
  double from_s = 0;            ///< samples used, counted from the first one's time
  double to_s = std::numeric_limits<double>::infinity();

  [[nodiscard]] ColumnMapping& operator[](Role role) { return columns[static_cast<std::size_t>(role)]; }
  [[nodiscard]] const ColumnMapping& operator[](Role role) const {
    return columns[static_cast<std::size_t>(role)];
  }
  /// Time, displacement, and command or pressure are said.
  [[nodiscard]] bool complete() const;
  bool operator==(const Mapping&) const = default;
};

/// The options of `softgrip import` that say the same: "--time 'Time (s)' --unit pressure=psi". Words are
/// quoted as a shell needs them.
[[nodiscard]] std::string options_of(const Mapping& mapping);

/// "comma", "tab" or a character; 0: none of these.
[[nodiscard]] char separator_named(std::string_view word);
/// The word of a separator.
[[nodiscard]] std::string_view word_of_separator(char separator);

}  // namespace softgrip::sysid
