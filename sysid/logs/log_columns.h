#pragma once
// The columns of the log contract: names, units, where their values go.

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// A column of the contract.
struct KnownColumn {
  std::string_view name;
  std::string_view quantity;  ///< the name without its unit
  bool required;
  bool may_be_empty;  ///< an empty cell says: no reading
  std::vector<double> Log::*values;
};

inline constexpr std::array<KnownColumn, 6> known_columns{{
    {"time_s", "time", true, false, &Log::time_s},
    {"pressure_command_kpa", "pressure_command", true, false, &Log::pressure_command_kpa},
    {"displacement_mm", "displacement", true, true, &Log::displacement_mm},
    {"pressure_kpa", "pressure", false, true, &Log::pressure_kpa},
    {"temperature_c", "temperature", false, true, &Log::temperature_c},
    {"supply_kpa", "supply", false, true, &Log::supply_kpa},
}};
inline constexpr std::size_t column_time = 0;
inline constexpr std::size_t column_command = 1;
inline constexpr std::size_t column_displacement = 2;
inline constexpr std::string_view channel_column = "channel";

/// A column that holds the readings of the finger.
struct ReadingColumn {
  std::string_view name;
  model::OutputUnit unit;
  double factor;  ///< from the column to the unit
};
/// A log has one of them. Of several the first is used; the others are kept as text.
inline constexpr std::array<ReadingColumn, 3> reading_columns{{
    {known_columns[column_displacement].name, model::OutputUnit::mm, 1},
    {"angle_deg", model::OutputUnit::deg, 1},
    {"angle_rad", model::OutputUnit::deg, model::deg_per_rad},
}};

/// How a log names a column: "angle_deg" of the readings of a log in deg.
[[nodiscard]] std::string_view column_name(const KnownColumn& known, const Log& log);

/// How to come from a unit that people write to the one of the contract: ", divide by 1000"; empty: unknown.
[[nodiscard]] std::string conversion(std::string_view unit);

}  // namespace softgrip::sysid
