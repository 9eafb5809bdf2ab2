#pragma once
// Describes the health of a finger: its recorded grips as points in time, the reference of every indicator,
// and the significant changes. judge_rig() (rig_health.h) computes this description.
//
// A point is one day (UTC) of a finger and holds, for each recipe, the median of the runs of this day.
// Changes within a day, mainly of the temperature, therefore do not count as random variation between grips.
// A run without a known time is a point of its own. After a repair, all charts of the finger start without a
// reference.
// Reads the maintenance records from notes.yaml, for example:
//
//   notes:
//     - {date: 2026-11-03, finger: left, action: finger replaced}
//     - {date: 2026-11-20T14:30:00Z, action: "sensors clamped again"}

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/health/control_chart.h"
#include "sysid/health/grip_score.h"

namespace softgrip::sysid::health {

struct Note {
  std::string date;    ///< date in UTC: "2026-11-03" (start of the day) or "2026-11-03T14:30:00Z"
  std::string finger;  ///< name of the finger; empty: the note applies to all fingers
  std::string action;  ///< maintenance action, in a few words
  /// Location of the name of the finger in the file of the notes, without a message.
  document::Problem finger_at = {};
};

/// Returns the notes in order of their dates. Returns nullopt if the text has problems, and adds all of them
/// to `problems`.
[[nodiscard]] std::optional<std::vector<Note>> read_notes(const std::string& path, std::string text,
                                                          document::Problems& problems);

/// Reads the file and returns its notes. The error is a sentence if the file cannot be read. The error is
/// empty if the text has problems, which are all added to `problems`.
[[nodiscard]] tl::expected<std::vector<Note>, std::string> load_notes(const std::string& path,
                                                                      document::Problems& problems);

struct HealthOptions {
  /// Mean number of points of a healthy finger between two false alarms, counted over all its indicators; at
  /// least 20. The charts of the differences from the peer fingers are not included in this number.
  double false_alarm_points = 3650;
  bool by_day = true;  ///< true: all runs of a day are one point; false: every run is a point

  [[nodiscard]] ChartLimits limits() const {
    return ChartLimits::for_run_length(false_alarm_points * static_cast<double>(sysid::health_numbers));
  }
};

struct HealthPoint {
  /// Label of the point: the day, such as "2026-11-22", or the name of the run.
  std::string label;
  std::size_t grips = 0;                                  ///< number of runs in this point
  std::size_t epoch = 0;                                  ///< number of maintenance records before this point
  std::array<ChartValues, sysid::health_numbers> values;  ///< median of each indicator for each recipe
  /// Deviation of each indicator from its reference, as a standard normal value.
  std::array<std::optional<double>, sysid::health_numbers> judged{};
  /// Difference from the peer fingers in the same runs, minus the reference of this difference. Absent if the
  /// finger has no peer fingers.
  std::array<std::optional<double>, sysid::health_numbers> beside{};
  std::optional<double> temperature_c;  ///< median temperature of the runs in this point [degC]
};

/// An alarm of the control chart of one indicator.
struct HealthAlarm {
  sysid::HealthNumber number = sysid::HealthNumber::gain;
  std::size_t epoch = 0;
  std::size_t noticed = 0;  ///< index of the point at which the alarm was raised
  std::size_t since = 0;    ///< index of the first point that the change affects
  double change = 0;        ///< size of the change, in the unit of the indicator
  std::size_t grips = 0;    ///< number of grips from the change to its detection
  /// Names of the peer fingers if the difference of the finger from them has changed. The list is empty if
  /// the finger's own values have changed.
  std::vector<std::string> beside;
  /// Index of the point at which the change of the difference was first reported, before the change was
  /// attributed to a finger. Equal to `noticed` if there was no such report.
  std::size_t warned = 0;
};

/// Reference of an indicator since the last maintenance record.
struct HealthReference {
  std::string recipe;  ///< recipe that has the most points; the reference belongs to this recipe
  double mean = 0;
  double spread = 0;
  std::size_t points = 0;
  /// Absent: the indicator does not depend significantly on the temperature.
  std::optional<TemperatureSlope> slope;

  /// Returns the expected value of the indicator.
  /// @param temperature_c  [degC]; absent: not recorded
  [[nodiscard]] double at(std::optional<double> temperature_c) const {
    return slope && temperature_c ? slope->at(*temperature_c) : mean;
  }
};

enum class FingerState : std::uint8_t {
  learning,  ///< since the last maintenance record, there are too few points to judge any indicator
  steady,
  alarm,
};
[[nodiscard]] const char* name_of(FingerState state);

struct FingerHealth {
  std::string finger;  ///< name of the finger; empty: the recordings name no finger
  FingerState state = FingerState::learning;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< output unit of the finger, which replaces mm in
                                                          ///< the units of the indicators
  std::vector<HealthPoint> points;
  std::vector<HealthAlarm> alarms;  ///< alarms of the whole history, ordered by the time of detection
  /// Changes of the difference between this finger and its peer fingers since the last maintenance record. A
  /// change is listed only if it is unknown which of the fingers has changed.
  std::vector<HealthAlarm> unclear;
  std::array<std::optional<HealthReference>, sysid::health_numbers> references{};
  /// Maintenance records, each with the index of the first point after it.
  std::vector<std::pair<std::size_t, Note>> notes;

  /// Returns the alarms that no repair has ended.
  [[nodiscard]] std::vector<HealthAlarm> standing() const;
  [[nodiscard]] std::size_t epoch() const { return points.empty() ? 0 : points.back().epoch; }
  /// Returns the median of an indicator at the last point that has this indicator; nullopt if no point has
  /// it.
  [[nodiscard]] std::optional<double> latest(sysid::HealthNumber number) const;
};

/// Returns the name of the finger for a sentence; "the finger" if it has no name.
[[nodiscard]] inline std::string name_in_text(const FingerHealth& health) {
  return health.finger.empty() ? "the finger" : health.finger;
}

/// Returns the indicators that have an active alarm in the same direction at all fingers, so that a common
/// cause is likely. The result is empty for fewer than two fingers.
[[nodiscard]] std::vector<sysid::HealthNumber> shared_changes(
    const std::vector<const FingerHealth*>& fingers);

}  // namespace softgrip::sysid::health
