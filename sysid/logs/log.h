#pragma once
// Reads and writes logs, which are recorded runs in CSV files. The reader refuses a file that contains an
// error, and the error message contains a hint. All logs that are given to one command form a campaign.
//
//   time_s,pressure_command_kpa,displacement_mm[,pressure_kpa][,temperature_c][,supply_kpa][,channel][,...]
//
// Instead of displacement_mm there may be a bending angle: angle_deg or angle_rad. The angle is stored in the
// member displacement_mm in deg, and the member output_unit is deg. The first line is the header. The
// separator is a comma, the decimal mark is a point, and the times increase from 0. Other columns are kept as
// text. An empty cell of the readings or of pressure_kpa is a missing reading. A sample without a reading is
// simulated, but not compared. The sampling may be irregular; the reader does not resample.

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "model/output_unit.h"

namespace softgrip::sysid {

/// A column that is not part of the log format. Its cells are stored as text and are not used.
struct OtherColumn {
  std::string name;
  std::vector<std::string> cells;

  bool operator==(const OtherColumn&) const = default;
};

/// A note about a log. A note is no reason to refuse the log.
struct LogNote {
  int line = 0;  ///< first line of the CSV text that the note concerns; 0: the note concerns the whole log
  std::string text;
  bool corrects = false;  ///< true: values of the log were replaced or removed, so a warning repeats the note
};

/// Statistics of the sampling intervals of a log.
struct Sampling {
  double median_interval_s = 0;
  double shortest_interval_s = 0;
  double longest_interval_s = 0;
  double jitter_s = 0;   ///< mean absolute deviation of the intervals from their median interval
  bool regular = false;  ///< true: the longest and the shortest interval differ by at most 0.2 % of the
                         ///< median interval

  /// Returns the median interval [s] if the intervals are regular, otherwise 0.
  [[nodiscard]] double sample_time_s() const { return regular ? median_interval_s : 0; }
};

/// The recorded run of one channel. All columns have as many values as time_s; optional columns may be empty
/// instead.
struct Log {
  std::string path;  ///< path of the file as the user wrote it
  /// Name of the log in legends: the file name without folder and extension (for a recording, the name of its
  /// folder), followed by the channel.
  std::string name;
  std::string channel;  ///< channel of the log; "" if the file has no channel column
  /// SHA-256 of the bytes of the file in lower-case hexadecimal; "" for a log that was created in memory.
  std::string sha256;
  std::vector<double> time_s;
  std::vector<double> pressure_command_kpa;
  std::vector<double> displacement_mm;  ///< reading at each sample, in `output_unit`; NaN: no reading
  /// Measured pressure; NaN: no reading; empty: the log has no such column.
  std::vector<double> pressure_kpa;
  std::vector<double> temperature_c;  ///< temperature at each sample; empty: the log has no such column
  std::vector<double> supply_kpa;     ///< supply pressure; empty: the log has no such column
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of `displacement_mm`
  std::vector<OtherColumn> others;
  std::vector<LogNote> notes;

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
};

/// Conditions that a log must meet, so that the reader accepts it.
struct LogOptions {
  std::string channel;  ///< channel that is read if a log has several channels; "": no channel is selected
  std::size_t bytes = std::size_t{512} * 1024 * 1024;
  /// True: a log with a constant command or a constant reading is refused, because such a log cannot identify
  /// a model.
  bool require_motion = true;
  /// False: only the command is used. A log then needs only two samples, gaps between samples are not
  /// checked, and the column displacement_mm may be absent.
  bool need_readings = true;
  /// If this unit is set, readings in a different unit are refused. `output_unit_of` names the origin of this
  /// unit ("the model given.yaml"). If this unit is not set, all logs of a campaign must have the unit of the
  /// first log.
  std::optional<model::OutputUnit> output_unit;
  std::string output_unit_of;
  /// Unit from which an import has converted the command ("bar"). "": the command of the file is in kPa.
  std::string command_unit;
  /// A log is refused if the share of clipped readings exceeds this value (1: never refused). If a smaller
  /// share of the readings is clipped, the log gets a note.
  double clipped_share_refused = 0.2;
};

/// Logs that are given together to one command.
struct Campaign {
  std::vector<Log> logs;
  /// True: a file could not be opened or read, or a folder contains no run.csv. An error in the content of a
  /// file does not count.
  bool unreadable = false;
};

/// Returns `name`, or a text such as "name (2)" if `used` contains the name. Adds the result to `used`.
[[nodiscard]] std::string unique_name(const std::string& name, std::set<std::string>& used);

/// Returns the file of the log at `path`: run.csv if `path` is the folder of a recording, otherwise `path`.
/// Returns an error sentence if `path` is a folder without run.csv.
[[nodiscard]] tl::expected<std::string, std::string> log_file_of(const std::string& path);

/// Reads logs in the given order. If a path is a folder, run.csv in this folder is read. All problems of all
/// files are added to `problems`. A log with a problem is left out of the result.
[[nodiscard]] Campaign read_campaign(const std::vector<std::string>& paths, document::Problems& problems,
                                     const LogOptions& options = {});

/// Reads a log from a text. `file` is the name of the text in messages.
[[nodiscard]] std::optional<Log> parse_log(const std::string& file, std::string_view text,
                                           document::Problems& problems, const LogOptions& options = {});

/// Returns the channels in the text of a log, in the order of their first rows. The list is empty if the log
/// has no channel column.
[[nodiscard]] std::vector<std::string> channels_of(std::string_view text);

/// Returns a log as CSV text. Each number is written with the fewest digits that give the same double, so
/// parse_log(format_log(log)) gives the same columns.
[[nodiscard]] std::string format_log(const Log& log);

/// Returns statistics of the sampling intervals of a log with at least two samples.
[[nodiscard]] Sampling sampling_of(const Log& log);

/// Returns the highest commanded pressure of the logs [kPa]; 0 if no command is above 0.
[[nodiscard]] double largest_command_kpa(const std::vector<Log>& logs);

/// Returns true if two logs have the same command apart from small deviations: the root mean square of the
/// difference is at most `share` times the largest command. The command of `other` is assumed to be constant
/// after its end.
/// @param log, other  logs with at least one sample.
[[nodiscard]] bool have_same_command(const Log& log, const Log& other, double share);

/// Returns the difference between the largest and the smallest reading [mm]; 0 if the log has no readings.
[[nodiscard]] double span_mm(const Log& log);

/// Returns the samples with the indices [first, last) as a log whose times begin at 0.
[[nodiscard]] Log slice(const Log& log, std::size_t first, std::size_t last);

}  // namespace softgrip::sysid
