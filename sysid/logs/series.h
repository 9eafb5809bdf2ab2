#pragma once
// The readings of a log and the predictions of models for each sample, so that users can make their own
// figures.
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

/// The series of one log. All vectors that are not empty are as long as time_s.
struct LogSeries {
  struct Predicted {
    std::string model;  ///< "identified", "given", "recalibrated", "extended"
    std::vector<double> mm;
  };

  std::string name;  ///< name of the log
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<double> time_s;
  std::vector<double> drive_kpa;    ///< input of the models; smoothed if it was measured
  std::vector<double> measured_mm;  ///< NaN: no reading
  std::vector<Predicted> predicted;
  std::vector<bool> held_out;  ///< empty: all readings were fitted
};

/// Returns the series of a log without predictions. A reading of the log that is missing in the record counts
/// as held out. `all_held_out`: no model was fitted to any reading.
[[nodiscard]] LogSeries series_of(const Log& log, const Record& record, bool all_held_out);

/// Returns the series as CSV.
[[nodiscard]] std::string series_csv(const LogSeries& series);

/// Returns the path of the series of a log within the folder of a command: "LOG/series.csv". Characters of
/// the name other than letters, digits and "-_. ()" are replaced by '_'.
[[nodiscard]] std::string series_path(std::string_view log_name);

}  // namespace softgrip::sysid
