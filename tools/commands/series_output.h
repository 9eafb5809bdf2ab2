#pragma once
// Writes the files that identify, validate and diagnose store beside their reports: series.csv for each log,
// and figures.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/series.h"

namespace CLI {
class App;
}

namespace softgrip::tools {

/// Returns the measured and predicted series of logs. `scores` contains the predictions, one element for each
/// log.
/// @param held_out  true: none of these logs was used to fit the model.
[[nodiscard]] std::vector<sysid::LogSeries> series_of(const std::vector<sysid::Log>& logs,
                                                      const std::vector<sysid::Record>& records,
                                                      const std::vector<sysid::Score>& scores,
                                                      const std::string& model, bool held_out);

/// Returns the series of a diagnosis: the given, the refitted and, if it exists, the extended model. Both
/// fitted models use all readings except outliers. The held-out results in diagnosis.json come from fits
/// without the held-out readings.
[[nodiscard]] std::vector<sysid::LogSeries> series_of(const sysid::Diagnosis& diagnosis,
                                                      const std::vector<sysid::Log>& logs);

/// Checks the folders of --out and --figures before a command computes a report, its series and its figures.
/// Prints a sentence and returns an exit code in two cases: a file of the report is an input, or cannot be
/// written (refuse_overwriting()); or the folder of --out contains the result of another command
/// (ExitCode::state_refused).
/// @param names  patterns of the files that the command writes, in addition to the report and the series.
/// They include the JSON file with the result of the command.
[[nodiscard]] std::optional<ExitCode> refuse_report(const std::string& out, const std::string& figures,
                                                    std::vector<std::string> names,
                                                    const std::vector<std::string>& inputs);

/// Adds --figures DIR to a command that writes a report. write_figures() (tools/figures) fills the folder.
void add_figures_option(CLI::App& command, std::string& folder);

/// Writes FOLDER/LOG/series.csv for each log. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<void, std::string> write_series(const std::string& folder,
                                                           const std::vector<sysid::LogSeries>& series);

}  // namespace softgrip::tools
