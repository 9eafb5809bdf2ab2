#pragma once
/// @file
/// Declares the estimation of the parameters of a model from logs. The changelog announces every incompatible
/// change of the functions. New versions may add members to the results.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/log.h>
#include <softgrip/model.h>

namespace softgrip {

/// 95 % interval of a number, in the unit of the number.
struct Interval {
  double lower = 0;  ///< lower end of the interval
  double upper = 0;  ///< upper end of the interval
};

/// A parameter that was estimated or kept fixed.
struct Estimate {
  std::string name;              ///< name of the parameter, for example "kelvin_voigt.k1_kpa_per_mm"
  std::string unit;              ///< unit of the value and of the interval
  double value = 0;              ///< estimated or fixed value of the parameter
  std::optional<Interval> ci95;  ///< 95 % interval; empty if the parameter is fixed, at a bound, or without
                                 ///< effect on the prediction
  bool free = false;             ///< true: the parameter was estimated; false: the parameter was fixed
  std::string note;              ///< reason why `ci95` is empty; empty text if `ci95` has a value
};

/// Prediction of one log by a model.
struct Prediction {
  std::string log;                  ///< name of the log
  Unit unit = Unit::mm;             ///< unit of the prediction and of the errors
  std::vector<double> time_s;       ///< times of the samples [s]
  std::vector<double> prediction;   ///< predicted reading of each sample, in `unit`
  std::vector<double> error;        ///< reading minus prediction; NaN where a reading is missing
  double rmse = 0;                  ///< root mean square error of the prediction, in `unit`
  double rmse_percent_of_span = 0;  ///< RMSE in percent of the range of the readings [%]
  double largest_error = 0;         ///< largest absolute error of the prediction, in `unit`
  /// True if the prediction is not finite. Also true if the RMSE of the prediction exceeds the range of the
  /// readings and the correlation of prediction and readings is low.
  bool diverges = false;
};

/// Function that a computation calls with a sentence about its present stage. Any thread may call the
/// function, but never two threads at the same time. If the function throws an exception, the computation
/// ends and its caller gets the exception.
using Progress = std::function<void(const std::string& stage)>;

/// The structure of the model that identify() fits.
enum class Structure : std::uint8_t {
  start,      ///< structure of IdentifyOptions::start; if start is empty, the default structure
  automatic,  ///< the structure with the smallest error on held-out blocks of the logs
  bouc_wen,   ///< the structure with the smallest error on held-out blocks, among structures with a Bouc-Wen
              ///< hysteresis
  prandtl_ishlinskii,  ///< the structure with the smallest error on held-out blocks, among structures with
                       ///< play operators
  play [[deprecated("use prandtl_ishlinskii")]] = prandtl_ishlinskii,  ///< deprecated name
};

/// Settings of identify(). If `structure` is not Structure::start, the settings `start`, `branches`, `fixed`,
/// `free` and `robust` must have their default values. Otherwise, identify() throws InvalidArgument.
struct IdentifyOptions {
  Structure structure = Structure::start;  ///< rule that determines the structure of the model
  std::optional<Model> start = {};         ///< model from which the fit starts
  std::size_t branches = 2;                ///< number of creep branches of the default structure, 1 to 8
  std::vector<std::string> fixed = {};     ///< names of the parameters that keep their value from `start`
  std::vector<std::string> free = {};      ///< names of the parameters that are estimated; empty: all
                                           ///< parameters except those in `fixed`
  std::size_t starts = 20;                 ///< number of start points, 1 to 10,000
  std::uint64_t seed = 1;                  ///< seed of the random start points
  bool robust = false;                     ///< true: Huber loss, in which the errors of outliers count
                                           ///< linearly and not quadratically
  double fit_share = 1;                    ///< share of each log that is fitted, from the start of the log;
                                           ///< 0.05 to 1
  unsigned threads = 0;                    ///< number of threads; 0: one per processor core
  LogUse use = {};                         ///< use of the logs: input, initial state, hold of the command
  std::vector<Log> validation = {};        ///< logs that are predicted but not fitted
  Progress progress = {};                  ///< function that is called with a text about the present stage of
                                           ///< the computation; may be empty
  std::stop_token stop = {};               ///< token through which the caller can end the computation early
};

/// Result of identify().
struct Identification {
  Model model;                         ///< the identified model
  double rmse = 0;                     ///< RMSE of all fitted samples, in the unit of the model
  bool converged = false;              ///< true: the minimisation of the squared error ended at a minimum
  std::string verdict;                 ///< assessment of the result in one sentence
  std::vector<std::string> warnings;   ///< warnings about the logs and the result
  std::vector<Estimate> parameters;    ///< all parameters of the model
  std::vector<Estimate> combinations;  ///< properties of the finger that are computed from the parameters
  std::vector<Prediction> fit;         ///< predictions of the fitted samples, one per log
  std::vector<Prediction> held_out;    ///< predictions of the samples that were not fitted, one per log
  std::vector<Prediction> validation;  ///< predictions of the logs in IdentifyOptions::validation
  std::string json;                    ///< content of identify.json that `softgrip identify` writes
  std::string html;                    ///< content of report.html that `softgrip identify` writes
};

/// Fits a model to logs, as `softgrip identify` does. The method is maximum likelihood by nonlinear least
/// squares from several start points. The intervals are computed from the curvature of the likelihood and the
/// correlation of the residuals. Throws InvalidArgument if an argument is invalid, Refused if the logs cannot
/// be fitted, and Cancelled after a request through `options.stop`.
/// @param logs     at least one log; all logs must have the same unit
/// @param options  settings of the structure, the start points and the fit
[[nodiscard]] SOFTGRIP_API Identification identify(const std::vector<Log>& logs,
                                                   const IdentifyOptions& options = {});

}  // namespace softgrip
