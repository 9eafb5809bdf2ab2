#pragma once
// Logs: recorded runs as CSV, read strictly and with help. Several logs given together are one campaign.
//
//   time_s,pressure_command_kpa,displacement_mm[,pressure_kpa][,temperature_c][,supply_kpa][,channel][,...]
//
// In the place of displacement_mm there may be angle_deg or angle_rad, a bending angle. It is read into
// displacement_mm in deg, and output_unit says so.
// First line the header, comma, decimal point, times from 0 and increasing. Other columns are kept as text.
// An empty cell in the readings or in pressure_kpa says that there was no reading: the sample is simulated
// but not compared. Sampling may be irregular; nothing here resamples.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "model/output_unit.h"

namespace softgrip::sysid {

/// A column that the log contract does not know: kept, ignored.
struct OtherColumn {
  std::string name;
  std::vector<std::string> cells;

  bool operator==(const OtherColumn&) const = default;
};

/// Something worth knowing about a log that is no reason to refuse it.
struct LogNote {
  int line = 0;  ///< of the CSV where it was seen first; 0: the whole log
  std::string text;
};

/// How a log was sampled.
struct Sampling {
  double median_interval_s = 0;
  double shortest_interval_s = 0;
  double longest_interval_s = 0;
  double jitter_s = 0;   ///< mean absolute deviation of the intervals from their median
  bool regular = false;  ///< all intervals within one per mille of the median

  /// 0 where they are not regular.
  [[nodiscard]] double sample_time_s() const { return regular ? median_interval_s : 0; }
};

/// One channel's recorded run. All columns have as many values as time_s; the optional ones may be empty.
struct Log {
  std::string path;     ///< as the user named it
  std::string name;     ///< short, for legends: the file's name without folder and ending, plus the channel
  std::string channel;  ///< "" where there is no channel column
  std::string sha256;   ///< of the file's bytes, lower-case hexadecimal; "" of a log made in memory
  std::vector<double> time_s;
  std::vector<double> pressure_command_kpa;
  std::vector<double> displacement_mm;  ///< in output_unit; NaN: no reading
  std::vector<double> pressure_kpa;     ///< measured; NaN: no reading; empty: no such column
  std::vector<double> temperature_c;    ///< empty: no such column
  std::vector<double> supply_kpa;       ///< empty: no such column
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< of the readings
  std::vector<OtherColumn> others;
  std::vector<LogNote> notes;

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
};

/// The logs that a reader accepts.
struct LogOptions {
  std::string channel;  ///< which one of a log with several; "" if there is one
  std::size_t bytes = std::size_t{512} * 1024 * 1024;
  /// Refuse what cannot identify a model: a constant command, a dead sensor.
  bool require_motion = true;
  /// False: only the command is used. Two samples, any distance between them and no displacement_mm will do.
  bool need_readings = true;
  /// Refuse readings in another unit; `output_unit_of` says what is in this one ("the model given.yaml").
  /// Without it, all logs of a campaign must agree with the first.
  std::optional<model::OutputUnit> output_unit;
  std::string output_unit_of;
  /// Refuse a log of which a larger share of the readings clips (1: never; less is only noted).
  double clipped_share_refused = 0.2;
};

/// The logs of a campaign, or why not.
struct Campaign {
  std::vector<Log> logs;
  bool unreadable = false;  ///< a file could not be opened or read: an I/O error rather than a bad log
};

/// Reads logs in the order given. A folder stands for the run.csv in it. All problems of all files are added
/// to `problems`; a log with a problem is left out.
[[nodiscard]] Campaign read_campaign(const std::vector<std::string>& paths, document::Problems& problems,
                                     const LogOptions& options = {});

/// Reads a log from a text. `file` is its name in messages.
[[nodiscard]] std::optional<Log> parse_log(const std::string& file, std::string_view text,
                                           document::Problems& problems, const LogOptions& options = {});

/// The channels of a log's text in the order of their first rows; none where there is no channel column.
[[nodiscard]] std::vector<std::string> channels_of(std::string_view text);

/// The CSV text of a log; numbers with the fewest digits that read back to the same double.
/// parse_log(format_log(log)) gives the same columns.
[[nodiscard]] std::string format_log(const Log& log);

/// Intervals between the samples. At least two samples.
[[nodiscard]] Sampling sampling_of(const Log& log);

/// The highest commanded pressure of some logs [kPa]; 0 without samples.
[[nodiscard]] double largest_command_kpa(const std::vector<Log>& logs);

/// The largest minus the smallest reading [mm]; 0 without readings.
[[nodiscard]] double span_mm(const Log& log);

/// Cuts samples [first, last) out of a log; times are shifted to start at 0.
[[nodiscard]] Log slice(const Log& log, std::size_t first, std::size_t last);

}  // namespace softgrip::sysid
