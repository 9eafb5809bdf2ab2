#pragma once
/// @file
/// Diagnosis of a model from measured logs: its error and the causes of this error. Also diagnosis of the
/// change of a finger since it was healthy. The changelog announces every incompatible change of the
/// functions. Later versions may add members to the results.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/identify.h>
#include <softgrip/log.h>
#include <softgrip/model.h>

namespace softgrip {

/// A cause of the error of a model, or of the change of a finger.
struct Cause {
  std::string id;     ///< for example "valve_deadband"; the reference page "causes" lists all ids
  std::string title;  ///< name of the cause in words
  /// Reduction of the held-out error by the cause [%]. In a Change, it is NaN.
  double error_reduction_percent = 0;
  Interval error_reduction_ci95;          ///< 95 % interval of error_reduction_percent [%]
  std::vector<Estimate> parameters;       ///< parameters of the cause; in a Change, the size of the change
  std::vector<std::string> alternatives;  ///< ids of causes that the logs cannot separate from this cause
};

/// Settings of diagnose() and diagnose_change().
struct DiagnoseOptions {
  std::uint64_t seed = 1;          ///< seed of start points and resampling
  unsigned threads = 0;            ///< number of threads; 0: one per processor core
  std::size_t null_campaigns = 0;  ///< number of data sets to simulate without any cause, to calibrate the
                                   ///< false-alarm threshold of the search
  LogUse use = {};                 ///< how the logs are used: input, initial state, hold of the command
  Progress progress = {};     ///< function that is called with a text about the present stage; may be empty
  std::stop_token stop = {};  ///< a request of its stop source ends the computation early
};

/// Result of diagnose().
struct Diagnosis {
  /// Verdict: "adequate", "recalibrate", "cause_found", "ambiguous", "partly_explained" or "unexplained".
  std::string verdict;
  std::string sentence;               ///< the verdict in one sentence
  std::vector<std::string> warnings;  ///< warnings about the logs and the result
  std::vector<Cause> causes;          ///< named causes, in the order in which they were found
  Unit unit = Unit::mm;               ///< unit of the noise and of the errors
  double noise = 0;                   ///< standard deviation of the noise of the readings
  double rmse_given = 0;              ///< root mean square error of the given model
  double rmse_refitted = 0;           ///< RMSE of the refitted model on held-out blocks
  double rmse_extended = 0;           ///< RMSE of the model with the causes on held-out blocks
  double unexplained_percent = 0;     ///< share of the model error that no cause explains [%]
  Model refitted;                     ///< model of the given structure with parameters that were estimated
                                      ///< again
  Model extended;                     ///< the refitted model, extended by the named causes
  std::string json;  ///< content of diagnosis.json that `softgrip diagnose` writes, without the experiment
                     ///< and the closed loop
  std::string html;  ///< content of report.html that `softgrip diagnose` writes, without the experiment and
                     ///< the closed loop
};

/// Diagnoses a model. Computes its error on the logs, finds the causes of this error, extends the model by
/// them, and computes the error reduction. `softgrip diagnose` uses the same functions. Throws
/// InvalidArgument, Refused if the logs cannot be diagnosed, and Cancelled.
/// @param model    the model to diagnose
/// @param logs     logs of one series of experiments, in the order of time and in the unit of the model
/// @param options  settings of the search
[[nodiscard]] SOFTGRIP_API Diagnosis diagnose(const Model& model, const std::vector<Log>& logs,
                                              const DiagnoseOptions& options = {});

/// Result of diagnose_change().
struct Change {
  std::string verdict;   ///< verdict: "unchanged", "cause_found", "ambiguous", "partly_explained" or
                         ///< "unexplained"
  std::string sentence;  ///< the verdict in one sentence
  std::vector<std::string> warnings;  ///< warnings about the logs and the result
  std::vector<Cause> causes;          ///< causes of the change of the finger, the largest change first
  Unit unit = Unit::mm;               ///< unit of all displacements in the result
  std::string json;                   ///< content of diagnosis.json that `softgrip diagnose --healthy` writes
  std::string html;                   ///< content of report.html that `softgrip diagnose --healthy` writes
};

/// Compares later logs of a finger with logs that were recorded when the finger was healthy. `softgrip
/// diagnose --healthy` uses the same functions. Throws InvalidArgument, Refused if the logs cannot be
/// compared, and Cancelled.
/// @param model    model of the healthy finger
/// @param healthy  logs of the healthy finger
/// @param later    logs of the same finger from a later time
/// @param options  settings of the search; `null_campaigns` is not used, and of `use`, only `held`
[[nodiscard]] SOFTGRIP_API Change diagnose_change(const Model& model, const std::vector<Log>& healthy,
                                                  const std::vector<Log>& later,
                                                  const DiagnoseOptions& options = {});

}  // namespace softgrip
