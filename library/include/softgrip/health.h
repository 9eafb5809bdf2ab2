#pragma once
/// @file
/// Changes of fingers in the recordings of ordinary grips. The changelog announces every incompatible change
/// of the function. Later versions may add members to the results.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/identify.h>

namespace softgrip {

/// The period of a point on a control chart.
enum class HealthPoints : std::uint8_t {
  day,  ///< one point for all recordings of a day (UTC): the median of their indicators
  run,  ///< one point for each recording
};

/// Settings of health(). They correspond to the options of `softgrip health`.
struct HealthOptions {
  HealthPoints points = HealthPoints::day;  ///< period of a point on a control chart
  /// Mean number of points between two false alarms of a healthy finger, 20 to 1e9.
  double false_alarm_points = 3650;
  std::string notes = {};  ///< path of the file of maintenance records (notes.yaml); empty: there is no such
                           ///< file
  /// Path of the file with the indicators of all recordings that were read so far (health-scores.jsonl). If
  /// the file exists, it is read, and the recordings in it are not read again. The call then replaces the
  /// file. Empty: no file is used.
  std::string scores = {};
  Progress progress = {};     ///< function that is called with a text about the present stage; may be empty
  std::stop_token stop = {};  ///< a request of its stop source ends the computation early
};

/// An indicator of a finger, such as the displacement at full pressure.
struct HealthIndicator {
  std::string id;                   ///< id, such as "gain_mm"; docs/how-to/watch-a-finger.md lists all ids
  std::string title;                ///< name of the indicator in words
  std::string unit;                 ///< unit of value, reference, spread and values
  std::optional<double> value;      ///< value at the last point that has one; empty if no point has one
  std::optional<double> reference;  ///< mean of the indicator since the last maintenance record
  std::optional<double> spread;     ///< standard deviation of the indicator since the last maintenance record
  std::vector<double> values;       ///< one value per point, for points with the recipe of the reference;
                                    ///< NaN: the point has no value
};

/// A significant change of an indicator.
struct HealthAlarm {
  std::string indicator;                ///< id of the indicator that changed
  double change = 0;                    ///< change relative to the reference, in the unit of the indicator
  std::string since;                    ///< label of the point at which the change began
  std::string noticed;                  ///< label of the point at which the change was detected
  std::size_t grips_until_noticed = 0;  ///< number of recordings between the points `since` and `noticed`
  bool active = false;                  ///< true: active; false: a maintenance record ended the alarm
};

/// A possible cause of the active alarms.
struct Suspect {
  std::string id;                       ///< id of the cause; the reference page "causes" lists all ids
  std::string words;                    ///< name of the cause in words
  std::vector<std::string> next_steps;  ///< checks that confirm this cause, the quickest check first
};

/// Health of one finger.
struct FingerHealth {
  std::string finger;               ///< name of the finger's channel
  std::string state;                ///< state of the finger: "learning", "steady" or "alarm"
  std::string sentence;             ///< the state of the finger in one sentence
  Unit unit = Unit::mm;             ///< unit of all displacements of the finger
  std::size_t grips = 0;            ///< number of recordings of the finger
  std::vector<std::string> points;  ///< labels of the points in the order of time: a day, or the name of a
                                    ///< recording
  std::vector<HealthIndicator> indicators;  ///< all indicators of the finger
  std::vector<HealthAlarm> alarms;          ///< alarms in the order in which they were detected
  std::vector<Suspect> suspects;            ///< possible causes of the active alarms; the first one explains
                                            ///< the most alarms
  std::vector<std::string> advice;          ///< measures that distinguish the possible causes
  std::string html;                         ///< report page of the finger
};

/// A recording that was not used.
struct SkippedRecording {
  std::string recording;  ///< name of the folder of the recording
  std::string reason;     ///< reason why the recording was not used, in words
};

/// Result of health().
struct Health {
  bool alarm = false;                     ///< true: an alarm of a finger is active
  std::vector<FingerHealth> fingers;      ///< fingers in the order of their names
  std::vector<std::string> warnings;      ///< changes that are not attributed to a finger
  std::vector<SkippedRecording> skipped;  ///< recordings that were not used
  std::string json;                       ///< content of health.json that `softgrip health` writes
};

/// Reports which fingers have changed, since when, and the possible causes. `softgrip health` uses the same
/// functions. Throws InvalidArgument. Throws FileError if the baseline, the notes or the scores are refused.
/// Throws Refused if no recording can be compared with the baseline. Throws Cancelled.
/// @param recordings  folders of recordings, or folders that contain such folders
/// @param baseline    folder of `softgrip baseline`. If it contains a folder with the name of a finger, the
///                    baseline in that folder applies to this finger
/// @param options     control charts, maintenance records and scores
[[nodiscard]] SOFTGRIP_API Health health(const std::vector<std::string>& recordings,
                                         const std::string& baseline, const HealthOptions& options = {});

}  // namespace softgrip
