#pragma once
/// @file
/// Health: changes of fingers in the recordings of ordinary grips. The function is stable; the results gain
/// fields.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/identify.h>

namespace softgrip {

/// Point of a control chart.
enum class HealthPoints : std::uint8_t {
  day,  ///< all recordings of a day (UTC): the median of their indicators
  run,  ///< each recording
};

/// Settings of health(), as the options of `softgrip health`.
struct HealthOptions {
  HealthPoints points = HealthPoints::day;  ///< point of a control chart
  /// Mean number of points between two false alarms of a healthy finger, 20 to 1e9.
  double false_alarm_points = 3650;
  std::string notes = {};  ///< file of maintenance records (notes.yaml); empty: none
  /// File of the indicators of all recordings so far (health-scores.jsonl). It is read if it exists, and
  /// replaced. Recordings that it contains are not read again. Empty: no file.
  std::string scores = {};
  Progress progress = {};     ///< may be empty
  std::stop_token stop = {};  ///< requests an early end
};

/// An indicator of a finger, such as the displacement at full pressure.
struct HealthIndicator {
  std::string id;                   ///< "gain_mm"; docs/how-to/watch-a-finger.md lists all
  std::string title;                ///< in words
  std::string unit;                 ///< of value, reference, spread and values
  std::optional<double> value;      ///< at the last point that has it
  std::optional<double> reference;  ///< mean since the last maintenance record
  std::optional<double> spread;     ///< standard deviation since the last maintenance record
  std::vector<double> values;       ///< one per point, of the recipe of the reference; NaN: none
};

/// A significant change of an indicator.
struct HealthAlarm {
  std::string indicator;                ///< its id
  double change = 0;                    ///< relative to the reference, in the unit of the indicator
  std::string since;                    ///< label of the point at which it began
  std::string noticed;                  ///< label of the point at which it was detected
  std::size_t grips_until_noticed = 0;  ///< recordings between the two
  bool active = false;                  ///< false: a maintenance record ended it
};

/// A possible cause of the active alarms.
struct Suspect {
  std::string id;                       ///< the reference page "causes" lists all
  std::string words;                    ///< the cause in words
  std::vector<std::string> next_steps;  ///< checks that confirm it, the quickest first
};

/// Health of one finger.
struct FingerHealth {
  std::string finger;               ///< name of the channel
  std::string state;                ///< "learning", "steady" or "alarm"
  std::string sentence;             ///< the state in one sentence
  Unit unit = Unit::mm;             ///< of displacements
  std::size_t grips = 0;            ///< recordings
  std::vector<std::string> points;  ///< labels in the order of time: a day, or the name of a recording
  std::vector<HealthIndicator> indicators;  ///< all indicators
  std::vector<HealthAlarm> alarms;          ///< in the order in which they were detected
  std::vector<Suspect> suspects;            ///< of the active alarms; the first explains most
  std::vector<std::string> advice;          ///< how to distinguish the suspects
  std::string html;                         ///< page of the finger
};

/// A recording that was not used.
struct SkippedRecording {
  std::string recording;  ///< name of its folder
  std::string reason;     ///< in words
};

/// Result of health().
struct Health {
  bool alarm = false;                     ///< an alarm of a finger is active
  std::vector<FingerHealth> fingers;      ///< by name
  std::vector<std::string> warnings;      ///< changes that are not attributed to a finger
  std::vector<SkippedRecording> skipped;  ///< recordings that were not used
  std::string json;                       ///< health.json of `softgrip health`
};

/// Reports which fingers have changed, since when, and possible causes. Same functions as `softgrip health`.
/// Throws InvalidArgument, FileError if the baseline, the notes or the scores are refused, Refused if no
/// recording can be compared with the baseline, Cancelled.
/// @param recordings  folders of recordings, or folders that contain them
/// @param baseline    folder of `softgrip baseline`. A folder in it with the name of a finger and its own
///                    baseline applies to that finger
/// @param options     charts, notes and scores
[[nodiscard]] SOFTGRIP_API Health health(const std::vector<std::string>& recordings,
                                         const std::string& baseline, const HealthOptions& options = {});

}  // namespace softgrip
