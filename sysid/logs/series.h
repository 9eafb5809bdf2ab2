#pragma once
// Series of a log: the readings and the predictions of models for each sample. Users make their own figures
// from them.
//
//   time_s,drive_kpa,measured_mm,predicted_MODEL_mm,residual_MODEL_mm[,...],held_out
//
// For a log in deg, the names end with _deg instead of _mm.
//
// An empty cell is a missing reading or prediction. held_out is 1 if no model was fitted to the reading.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The series of one log. All vectors that are not empty have one value per sample.
struct LogSeries {
  struct Predicted {
    std::string model;  ///< "identified", "given", "recalibrated", "extended"
    std::vector<double> mm;
  };

  std::string name;  ///< name of the log
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<double> time_s;
  std::vector<double> drive_kpa;    ///< input of the models; a measured pressure is smoothed
  std::vector<double> measured_mm;  ///< NaN: no reading
  std::vector<Predicted> predicted;
  std::vector<bool> held_out;  ///< true: no model was fitted to this reading; empty: all readings were fitted
};

/// Returns the series of a log without predictions. A reading of the log that is missing in the record counts
/// as held out. If `all_held_out`, all readings count as held out.
[[nodiscard]] LogSeries series_of(const Log& log, const Record& record, bool all_held_out);

/// Returns the series as CSV.
[[nodiscard]] std::string series_csv(const LogSeries& series);

/// Returns the path of the series of a log, relative to the output folder of a command: "LOG/series.csv".
/// Characters of the name other than letters, digits and "-_. ()" are replaced by '_'.
[[nodiscard]] std::string series_path(std::string_view log_name);

}  // namespace softgrip::sysid
