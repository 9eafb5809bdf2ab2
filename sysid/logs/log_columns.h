#pragma once
// Defines the columns of the log format: their names, their units, and the members of Log that store their
// values.
// Collects the problems of a log. Shows only the first problems of each kind, so that the report of a file
// with a million bad rows has only a few lines.

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// A column of the log format, with its name and its unit.
struct KnownColumn {
  std::string_view name;
  std::string_view quantity;  ///< name of the column without its unit
  bool required;
  bool may_be_empty;  ///< true: a cell may be empty, which means a missing reading
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

/// A column that can contain the readings of the displacement.
struct ReadingColumn {
  std::string_view name;
  model::OutputUnit unit;
  double factor;  ///< the value in the log is the value in the column times this factor
};
/// Columns that can contain the readings; a log must have at least one of them. If a log has several of these
/// columns, the first one in this list is used, and the other ones are stored as text.
inline constexpr std::array<ReadingColumn, 3> reading_columns{{
    {known_columns[column_displacement].name, model::OutputUnit::mm, 1},
    {"angle_deg", model::OutputUnit::deg, 1},
    {"angle_rad", model::OutputUnit::deg, model::deg_per_rad},
}};

/// Returns the name of a column in the file of a log. If the unit of the log is deg, the name of the column
/// of readings is "angle_deg".
[[nodiscard]] std::string_view column_name(const KnownColumn& known, const Log& log);

/// Returns the conversion of a unit to the unit of the log format as a text, such as ", divide by 1000".
/// Returns "" for an unknown unit.
[[nodiscard]] std::string conversion(std::string_view unit);

/// Reports the first problems of each kind and counts the remaining problems of the same kind.
class LogReporter {
 public:
  LogReporter(std::string file, document::Problems& problems) : file_(std::move(file)), problems_(problems) {}

  void add(const std::string& kind, document::Location at, std::string_view line, std::string message,
           std::string hint = {});
  /// For each kind with more than three problems, adds a problem that states how many of them are not shown.
  void finish();
  [[nodiscard]] bool any() const { return !counts_.empty(); }

 private:
  std::string file_;
  document::Problems& problems_;
  std::map<std::string, int> counts_;
  std::map<std::string, std::pair<document::Location, std::string>> last_;
};

}  // namespace softgrip::sysid
