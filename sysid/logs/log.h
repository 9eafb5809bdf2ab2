#pragma once
// Logs: recorded runs as CSV. The reader is strict, and its messages contain hints. The logs that are given
// together to one command are a campaign.
//
//   time_s,pressure_command_kpa,displacement_mm[,pressure_kpa][,temperature_c][,supply_kpa][,channel][,...]
//
// Instead of displacement_mm there may be a bending angle: angle_deg or angle_rad. It is stored in
// displacement_mm in deg, and output_unit is deg. The first line is the header. The separator is a comma, the
// decimal mark is a point, and the times increase from 0. Other columns are kept as text. An empty cell of
// the readings or of pressure_kpa is a missing reading: the sample is simulated, but not compared with a
// reading. The sampling may be irregular; the reader does not resample.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "model/output_unit.h"

namespace softgrip::sysid {

/// A column that does not belong to the log format. It is stored as text and not used.
struct OtherColumn {
  std::string name;
  std::vector<std::string> cells;

  bool operator==(const OtherColumn&) const = default;
};

/// A note about a log that is not a reason to refuse it.
struct LogNote {
  int line = 0;  ///< first line of the CSV to which the note applies; 0: the whole log
  std::string text;
};

/// Statistics of the sampling intervals of a log.
struct Sampling {
  double median_interval_s = 0;
  double shortest_interval_s = 0;
  double longest_interval_s = 0;
  double jitter_s = 0;   ///< mean absolute deviation of the intervals from their median
  bool regular = false;  ///< no interval differs from the median by more than one per mille

  /// Returns the median interval [s], or 0 if the intervals are not regular.
  [[nodiscard]] double sample_time_s() const { return regular ? median_interval_s : 0; }
};

/// One channel's recorded run. All columns have as many values as time_s; the optional ones may be empty.
struct Log {
  std::string path;  ///< path as the user gave it
  /// Name for legends: the file's name without folder and extension, followed by the channel.
  std::string name;
  std::string channel;  ///< "" if there is no channel column
  std::string sha256;   ///< hash of the file's bytes, lower-case hexadecimal; "" for a log created in memory
  std::vector<double> time_s;
  std::vector<double> pressure_command_kpa;
  std::vector<double> displacement_mm;  ///< in output_unit; NaN: no reading
  std::vector<double> pressure_kpa;     ///< measured; NaN: no reading; empty: no such column
  std::vector<double> temperature_c;    ///< empty: no such column
  std::vector<double> supply_kpa;       ///< empty: no such column
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of the readings
  std::vector<OtherColumn> others;
  std::vector<LogNote> notes;

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
};

/// Conditions that a reader requires of logs.
struct LogOptions {
  std::string channel;  ///< the channel to read if a log has several channels; otherwise ""
  std::size_t bytes = std::size_t{512} * 1024 * 1024;
  /// Refuse logs that cannot identify a model because the command or the reading is constant.
  bool require_motion = true;
  /// If false, only the command is used. Two samples at any interval then suffice, and displacement_mm may be
  /// absent.
  bool need_readings = true;
  /// Refuse readings in another unit than this. `output_unit_of` names the origin of the required unit ("the
  /// model given.yaml"). Without a required unit, all logs of a campaign must have the unit of the first log.
  std::optional<model::OutputUnit> output_unit;
  std::string output_unit_of;
  /// Refuse a log if more than this share of its readings is clipped (1: never refuse). If the share is
  /// smaller, a note is added.
  double clipped_share_refused = 0.2;
};

/// The logs of a campaign.
struct Campaign {
  std::vector<Log> logs;
  bool unreadable = false;  ///< a file could not be opened or read (an I/O error, not a bad log)
};

/// Reads logs in the given order. For a folder, run.csv in it is read. All problems of all files are added to
/// `problems`; a log with a problem is left out.
[[nodiscard]] Campaign read_campaign(const std::vector<std::string>& paths, document::Problems& problems,
                                     const LogOptions& options = {});

/// Reads a log from a text. `file` names the text in messages.
[[nodiscard]] std::optional<Log> parse_log(const std::string& file, std::string_view text,
                                           document::Problems& problems, const LogOptions& options = {});

/// Returns the channels in the text of a log, in the order of their first rows. The list is empty if the log
/// has no channel column.
[[nodiscard]] std::vector<std::string> channels_of(std::string_view text);

/// Returns the CSV text of a log. Numbers have the fewest digits that represent the same double, so
/// parse_log(format_log(log)) gives the same columns.
[[nodiscard]] std::string format_log(const Log& log);

/// Returns statistics of the sampling intervals. The log must have at least two samples.
[[nodiscard]] Sampling sampling_of(const Log& log);

/// Returns the highest commanded pressure of the logs [kPa]; 0 without samples.
[[nodiscard]] double largest_command_kpa(const std::vector<Log>& logs);

/// Returns the largest minus the smallest reading [mm]; 0 without readings.
[[nodiscard]] double span_mm(const Log& log);

/// Returns the samples with the indices [first, last) as a log whose times begin at 0.
[[nodiscard]] Log slice(const Log& log, std::size_t first, std::size_t last);

}  // namespace softgrip::sysid
