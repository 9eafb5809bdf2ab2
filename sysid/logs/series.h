#pragma once
// Writes the series of a log as CSV: for each sample, the reading and the predictions of the models. Users
// make their own figures from these files.
//
//   time_s,drive_kpa,measured_mm,predicted_MODEL_mm,residual_MODEL_mm[,...],held_out
//
// For a log in deg, the names end with _deg instead of _mm.
//
// An empty cell is a missing reading or a missing prediction. In the column held_out, 1 means that no model
// was fitted to the reading.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Readings and predictions of one log. All vectors that are not empty have one value per sample.
struct LogSeries {
  struct Predicted {
    std::string model;  ///< id of the model: "identified", "given", "recalibrated" or "extended"
    std::vector<double> mm;
  };

  std::string name;  ///< name of the log
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<double> time_s;
  std::vector<double> drive_kpa;    ///< input of the models at each sample; a measured pressure is smoothed
  std::vector<double> measured_mm;  ///< reading at each sample; NaN: no reading
  std::vector<Predicted> predicted;
  std::vector<bool> held_out;  ///< true: no model was fitted to this reading; empty: all readings were fitted
};

/// Returns the input and the readings of a log as a series that contains no predictions. The record contains
/// the readings that may be fitted. All other readings of the log count as held out. If `all_held_out` is
/// true, all readings count as held out.
[[nodiscard]] LogSeries series_of(const Log& log, const Record& record, bool all_held_out);

/// Returns the series as CSV text with a header line.
[[nodiscard]] std::string series_csv(const LogSeries& series);

/// Returns the path of the series file of a log, relative to the output folder of a command:
/// "LOG/series.csv". LOG is the name of the log, in which '_' replaces every character except letters, digits
/// and "-_. ()".
[[nodiscard]] std::string series_path(std::string_view log_name);

}  // namespace softgrip::sysid
