#pragma once
// Writes the files that identify, validate and diagnose store beside their reports: series.csv for each log,
// and figures. A series contains, for each sample, the reading and the predictions of the models. Users make
// their own figures from these files.
//
//   time_s,drive_kpa,measured_mm,predicted_MODEL_mm,residual_MODEL_mm[,...],held_out
//
// For a log in deg, the names end with _deg instead of _mm.
//
// An empty cell is a missing reading or a missing prediction. In the column held_out, 1 means that no model
// was fitted to the reading.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace CLI {
class App;
}

namespace softgrip::tools {

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
[[nodiscard]] LogSeries series_of(const sysid::Log& log, const sysid::Record& record, bool all_held_out);

/// Returns the series as CSV text with a header line.
[[nodiscard]] std::string series_csv(const LogSeries& series);

/// Returns the folder of the series file of a log, relative to the output folder of a command. It is the name
/// of the log, in which '_' replaces every character except letters, digits and "-_. ()".
[[nodiscard]] std::string series_folder(std::string_view log_name);

/// Returns the measured and predicted series of logs. `scores` contains the predictions, one element for each
/// log.
/// @param held_out  true: none of these logs was used to fit the model.
[[nodiscard]] std::vector<LogSeries> series_of(const std::vector<sysid::Log>& logs,
                                               const std::vector<sysid::Record>& records,
                                               const std::vector<sysid::Score>& scores,
                                               const std::string& model, bool held_out);

/// Returns the series of a diagnosis: the given, the refitted and, if it exists, the extended model. Both
/// fitted models use all readings except outliers. The held-out results in diagnosis.json come from fits
/// without the held-out readings.
[[nodiscard]] std::vector<LogSeries> series_of(const sysid::Diagnosis& diagnosis,
                                               const std::vector<sysid::Log>& logs);

/// Checks the folders of --out and --figures before a command computes a report, its series and its figures.
/// Prints a sentence and returns an exit code in three cases: a file of the report is an input, or cannot be
/// written (refuse_overwriting()); the folder of --out contains the result of another command
/// (ExitCode::state_refused); or a folder cannot be created or written (ExitCode::io).
/// @param names  patterns of the files that the command writes, in addition to the report and the series.
/// They include the JSON file with the result of the command.
[[nodiscard]] std::optional<ExitCode> refuse_report(const std::string& out, const std::string& figures,
                                                    std::vector<std::string> names,
                                                    const std::vector<std::string>& inputs);

/// Adds --figures DIR to a command that writes a report. write_figures() (tools/figures) fills the folder.
void add_figures_option(CLI::App& command, std::string& folder);

/// Writes FOLDER/LOG/series.csv for each log. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<void, std::string> write_series(const std::string& folder,
                                                           const std::vector<LogSeries>& series);

}  // namespace softgrip::tools
