#pragma once
/// @file
/// Declares the detection of changed fingers from the recordings of ordinary grips. The changelog announces
/// every incompatible change of the function. New versions may add members to the results.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/identify.h>

namespace softgrip {

/// The period to which one point of a control chart belongs.
enum class HealthPoints : std::uint8_t {
  day,  ///< one point for all recordings of a day (UTC): the median of the indicators of these recordings
  run,  ///< one point for each recording
};

/// Settings of health(). They correspond to the options of `softgrip health`.
struct HealthOptions {
  HealthPoints points = HealthPoints::day;  ///< period to which one point of a control chart belongs
  /// Mean number of points between two false alarms of a healthy finger, 20 to 1e9.
  double false_alarm_points = 3650;
  std::string notes = {};  ///< path of the file with maintenance records (notes.yaml); empty: no such file is
                           ///< used
  /// Path of the file that stores the indicators of all recordings that were read so far
  /// (health-scores.jsonl). Recordings whose indicators for the current baseline are in this file are not
  /// read again. health() replaces the file at the end. Empty: no file is used.
  std::string scores = {};
  Progress progress = {};     ///< function that is called with a text about the present stage of the
                              ///< computation; may be empty
  std::stop_token stop = {};  ///< token through which the caller can end the computation early
};

/// An indicator of a finger, such as the displacement at full pressure.
struct HealthIndicator {
  std::string id;                   ///< id, such as "gain_mm"; docs/how-to/watch-a-finger.md lists all ids
  std::string title;                ///< name of the indicator in words
  std::string unit;                 ///< unit of the members value, reference, spread and values
  std::optional<double> value;      ///< value of the indicator at the last point that has a value; empty if
                                    ///< no point has a value
  std::optional<double> reference;  ///< mean of the indicator since the last maintenance record
  std::optional<double> spread;     ///< standard deviation of the indicator since the last maintenance record
  std::vector<double> values;       ///< value of the indicator at each point, for the recipe of the
                                    ///< reference; NaN: the point has no such value
};

/// A significant change of an indicator.
struct HealthAlarm {
  std::string indicator;                ///< id of the indicator that changed
  double change = 0;                    ///< difference between the indicator and its reference, in the unit
                                        ///< of the indicator
  std::string since;                    ///< label of the point at which the change began
  std::string noticed;                  ///< label of the point at which the change was detected
  std::size_t grips_until_noticed = 0;  ///< number of recordings from the point `since` to the point
                                        ///< `noticed`
  bool active = false;                  ///< true: the alarm is active; false: a maintenance record has ended
                                        ///< the alarm
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
  std::vector<std::string> points;  ///< labels of the points in the order of time; a label is a day or the
                                    ///< name of a recording
  std::vector<HealthIndicator> indicators;  ///< all indicators of the finger
  std::vector<HealthAlarm> alarms;          ///< alarms in the order in which they were detected
  std::vector<Suspect> suspects;            ///< possible causes of the active alarms; the first cause agrees
                                            ///< best with the alarms
  std::vector<std::string> advice;          ///< measures with which the user can distinguish the possible
                                            ///< causes
  std::string html;                         ///< report page of the finger
};

/// A recording that was not used, or in which one finger was not used.
struct SkippedRecording {
  std::string recording;  ///< name of the folder of the recording
  std::string reason;     ///< reason why the recording was not used, in words
};

/// Result of health().
struct Health {
  bool alarm = false;                     ///< true: at least one finger has an active alarm
  std::vector<FingerHealth> fingers;      ///< health of each finger, in the order of the fingers' names
  std::vector<std::string> warnings;      ///< warnings about changes that several fingers share, and about
                                          ///< changes that are not attributed to a finger
  std::vector<SkippedRecording> skipped;  ///< recordings that were not used
  std::string json;                       ///< content of health.json that `softgrip health` writes
};

/// Reports which fingers have changed, when each change began, and the possible causes of each change. The
/// command `softgrip health` computes its result in the same way. Throws InvalidArgument if an argument is
/// invalid. Throws FileError if the baseline does not exist, or if the content of the baseline, the notes or
/// the scores is invalid. Throws Refused if no recording can be compared with the baseline. Throws Cancelled
/// after a request through `options.stop`.
/// @param recordings  folders of recordings, or folders that contain such folders
/// @param baseline  folder of `softgrip baseline`. If it contains a folder with the name of a finger, the
/// baseline in that folder applies to this finger
/// @param options  control charts, maintenance records and scores
[[nodiscard]] SOFTGRIP_API Health health(const std::vector<std::string>& recordings,
                                         const std::string& baseline, const HealthOptions& options = {});

}  // namespace softgrip
