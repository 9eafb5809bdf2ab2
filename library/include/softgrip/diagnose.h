#pragma once
/// @file
/// Declares two diagnoses from measured logs. The first diagnosis determines the error of a model and the
/// causes of this error. The second diagnosis determines how a finger has changed since it was healthy. The
/// changelog announces every incompatible change of the functions. New versions may add members to the
/// results.

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
  std::string id;     ///< id of the cause, for example "valve_deadband"; the reference page "causes" lists
                      ///< all ids
  std::string title;  ///< name of the cause in words
  /// Reduction of the error by the cause [%]. In a Diagnosis, the error is that of held-out blocks. The value
  /// is NaN if only one-step predictions in a closed loop show the cause. In a Change, the error is the
  /// whitened RMS error of the later logs. These logs were not used for the fit of the baseline model, but
  /// the size of the cause is fitted to them. The value is NaN for the causes "outliers" and "sampling",
  /// which are found without a fit.
  double error_reduction_percent = 0;
  Interval error_reduction_ci95;          ///< 95 % interval of error_reduction_percent [%]; NaN if
                                          ///< error_reduction_percent is NaN
  std::vector<Estimate> parameters;       ///< estimated parameters of the cause; in a Change: the size of the
                                          ///< change of the finger
  std::vector<std::string> alternatives;  ///< ids of alternative causes that the logs cannot separate from
                                          ///< this cause
};

/// Settings of diagnose() and diagnose_change().
struct DiagnoseOptions {
  std::uint64_t seed = 1;          ///< seed of the random start points and of the bootstrap
  unsigned threads = 0;            ///< number of threads; 0: one per processor core
  std::size_t null_campaigns = 0;  ///< number of data sets that are simulated without any cause, to calibrate
                                   ///< the false-alarm threshold of the search
  LogUse use = {};                 ///< use of the logs: input, initial state, hold of the command
  Progress progress = {};          ///< function that is called with a text about the present stage of the
                                   ///< computation; may be empty
  std::stop_token stop = {};       ///< token through which the caller can end the computation early
};

/// Result of diagnose().
struct Diagnosis {
  /// Verdict: "adequate", "recalibrate", "cause_found", "ambiguous", "partly_explained" or "unexplained".
  std::string verdict;
  std::string sentence;               ///< the verdict in one sentence
  std::vector<std::string> warnings;  ///< warnings about the logs and the result
  std::vector<Cause> causes;          ///< causes of the model error, in the order in which they were found
  Unit unit = Unit::mm;               ///< unit of `noise` and of all errors
  double noise = 0;                   ///< standard deviation of the noise of the readings
  double rmse_given = 0;              ///< root mean square error of the given model on the logs
  double rmse_refitted = 0;           ///< RMSE of the refitted model on the held-out blocks
  double rmse_extended = 0;           ///< RMSE of the extended model (refitted model with the causes) on the
                                      ///< held-out blocks
  double unexplained_percent = 0;     ///< share of the model error that no cause explains [%]
  Model refitted;                     ///< model with the given structure, whose parameters were estimated
                                      ///< again
  Model extended;                     ///< refitted model, extended by the causes in `causes`
  std::string json;  ///< content of diagnosis.json as `softgrip diagnose` writes it, without the parts about
                     ///< the experiment and the closed loop
  std::string html;  ///< content of report.html as `softgrip diagnose` writes it, without the parts about the
                     ///< experiment and the closed loop
};

/// Diagnoses a model. Computes the error of the model on the logs and finds the causes of this error. Extends
/// the model by these causes and computes the error reduction. The command `softgrip diagnose` computes its
/// result in the same way. Throws InvalidArgument if an argument is invalid, Refused if the logs cannot be
/// diagnosed, and Cancelled after a request through `options.stop`.
/// @param model  the model to diagnose
/// @param logs  logs of one series of experiments, in the order of time and in the unit of the model
/// @param options  settings of the search
[[nodiscard]] SOFTGRIP_API Diagnosis diagnose(const Model& model, const std::vector<Log>& logs,
                                              const DiagnoseOptions& options = {});

/// Result of diagnose_change().
struct Change {
  std::string verdict;   ///< verdict: "unchanged", "cause_found", "ambiguous", "partly_explained" or
                         ///< "unexplained"
  std::string sentence;  ///< the verdict in one sentence
  std::vector<std::string> warnings;  ///< warnings about the logs and the result
  std::vector<Cause> causes;  ///< causes of the change of the finger; the first cause reduces the error
                              ///< most
  Unit unit = Unit::mm;       ///< unit of all displacements in the result
  std::string json;           ///< content of diagnosis.json that `softgrip diagnose --healthy` writes
  std::string html;           ///< content of report.html that `softgrip diagnose --healthy` writes
};

/// Compares later logs of a finger with logs that were recorded when the finger was healthy. The command
/// `softgrip diagnose --healthy` computes its result in the same way. Throws InvalidArgument if an argument
/// is invalid, Refused if the logs cannot be compared, and Cancelled after a request through `options.stop`.
/// @param model  model of the healthy finger
/// @param healthy  logs of the healthy finger
/// @param later  logs of the same finger from a later time
/// @param options  settings of the search; the function uses all of them except `null_campaigns`, `use.drive`
/// and `use.begin`
[[nodiscard]] SOFTGRIP_API Change diagnose_change(const Model& model, const std::vector<Log>& healthy,
                                                  const std::vector<Log>& later,
                                                  const DiagnoseOptions& options = {});

}  // namespace softgrip
