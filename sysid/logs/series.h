#pragma once
// The readings of a log and the predictions of models, sample by sample, for the user's own figures.
//
//   time_s,drive_kpa,measured_mm,predicted_MODEL_mm,residual_MODEL_mm[,...],held_out
//
// Of a log in deg, the names end with _deg in the place of _mm.
//
// An empty cell says that there is no reading, or no prediction. held_out is 1 where no model was fitted to
// the reading.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// One log's. All vectors that are not empty are as long as time_s.
struct LogSeries {
  struct Predicted {
    std::string model;  ///< "identified", "given", "recalibrated", "extended"
    std::vector<double> mm;
  };

  std::string name;  ///< of the log
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<double> time_s;
  std::vector<double> drive_kpa;    ///< what drove the models: smoothed where it was measured
  std::vector<double> measured_mm;  ///< NaN: no reading
  std::vector<Predicted> predicted;
  std::vector<bool> held_out;  ///< empty: all were fitted
};

/// A log and its record, without predictions yet. Readings that the record lacks and the log has were held
/// out; `all_held_out`: no model was fitted to any.
[[nodiscard]] LogSeries series_of(const Log& log, const Record& record, bool all_held_out);

/// The CSV text.
[[nodiscard]] std::string series_csv(const LogSeries& series);

/// Where a command writes it, within its folder: "LOG/series.csv". Of a name nothing is left that is no
/// letter, digit or one of "-_. ()".
[[nodiscard]] std::string series_path(std::string_view log_name);

}  // namespace softgrip::sysid
