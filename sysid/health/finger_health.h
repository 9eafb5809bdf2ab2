#pragma once
// Describes the health of a finger: its recorded grips as points in time, the reference of every indicator,
// and the significant changes. judge_rig() (rig_health.h) computes it.
//
// A point is one day (UTC) of a finger and holds the median of the runs of each recipe. Changes within a day,
// mainly of the temperature, therefore do not count as random variation between grips. A run without a known
// time is a point of its own. A repair restarts all charts of the finger.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/health/control_chart.h"
#include "sysid/health/grip_score.h"
#include "sysid/health/notes_file.h"

namespace softgrip::sysid::health {

struct HealthOptions {
  /// Mean number of points of a healthy finger between two false alarms of any of its charts; at least 20.
  double false_alarm_points = 3650;
  bool by_day = true;  ///< false: every run is a point

  [[nodiscard]] ChartLimits limits() const {
    return ChartLimits::for_run_length(false_alarm_points * static_cast<double>(sysid::health_numbers));
  }
};

struct HealthPoint {
  std::string label;                                      ///< "2026-11-22", or the run's name
  std::size_t grips = 0;                                  ///< runs
  std::size_t epoch = 0;                                  ///< number of earlier maintenance records
  std::array<ChartValues, sysid::health_numbers> values;  ///< medians by recipe
  std::array<std::optional<double>, sysid::health_numbers> judged{};  ///< as standard normal values
  /// Difference from the peer fingers in the same runs, minus the reference of this difference. Absent if the
  /// finger has no peer fingers.
  std::array<std::optional<double>, sysid::health_numbers> beside{};
  std::optional<double> temperature_c;  ///< median temperature of the runs
};

/// An alarm of one indicator.
struct HealthAlarm {
  sysid::HealthNumber number = sysid::HealthNumber::gain;
  std::size_t epoch = 0;
  std::size_t noticed = 0;  ///< index of the point at which the alarm was raised
  std::size_t since = 0;    ///< index of the first changed point
  double change = 0;        ///< in the unit of the indicator
  std::size_t grips = 0;    ///< number of grips from the change to its detection
  /// Peer fingers, if the alarm concerns the difference from them; empty if the alarm concerns the finger's
  /// own values.
  std::vector<std::string> beside;
  /// Index of the point at which the change of the difference was first reported without an assigned finger.
  /// Equal to `noticed` if there was no such report.
  std::size_t warned = 0;
};

/// Reference of an indicator since the last maintenance record.
struct HealthReference {
  std::string recipe;  ///< the recipe with the most points
  double mean = 0;
  double spread = 0;
  std::size_t points = 0;
  std::optional<TemperatureSlope> slope;  ///< absent: no dependence on the temperature is known

  /// Returns the expected value of the indicator. @param temperature_c  absent: not recorded
  [[nodiscard]] double at(std::optional<double> temperature_c) const {
    return slope && temperature_c ? slope->at(*temperature_c) : mean;
  }
};

enum class FingerState : std::uint8_t {
  learning,  ///< too few points since the last maintenance record to judge any indicator
  steady,
  alarm,
};
[[nodiscard]] const char* name_of(FingerState state);

struct FingerHealth {
  std::string finger;
  FingerState state = FingerState::learning;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of the indicators that are listed in mm
  std::vector<HealthPoint> points;
  std::vector<HealthAlarm> alarms;  ///< of all epochs, in the order in which they were noticed
  /// Changed differences from the peer fingers since the last maintenance record that are not attributed to a
  /// finger.
  std::vector<HealthAlarm> unclear;
  std::array<std::optional<HealthReference>, sysid::health_numbers> references{};
  std::vector<std::pair<std::size_t, Note>> notes;  ///< index of the first point after the record

  /// Returns the alarms that are still active.
  [[nodiscard]] std::vector<HealthAlarm> standing() const;
  [[nodiscard]] std::size_t epoch() const { return points.empty() ? 0 : points.back().epoch; }
  /// Returns the median of an indicator at the last point that has it; empty if no point has it.
  [[nodiscard]] std::optional<double> latest(sysid::HealthNumber number) const;
};

/// Returns the indicators that have an active alarm in the same direction at all fingers, so that a common
/// cause is likely. The result is empty for fewer than two fingers.
[[nodiscard]] std::vector<sysid::HealthNumber> shared_changes(
    const std::vector<const FingerHealth*>& fingers);

}  // namespace softgrip::sysid::health
