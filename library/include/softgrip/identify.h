#pragma once
/// @file
/// Identification: parameters of a model from logs. The functions are stable; later versions may add fields
/// to the results.

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

/// 95 % interval of a number, in its unit.
struct Interval {
  double lower = 0;  ///< lower end
  double upper = 0;  ///< upper end
};

/// An estimated or fixed parameter.
struct Estimate {
  std::string name;              ///< for example "kelvin_voigt.k1_kpa_per_mm"
  std::string unit;              ///< unit of value and interval
  double value = 0;              ///< estimated or fixed value
  std::optional<Interval> ci95;  ///< empty if the parameter is fixed, at a bound, or without effect
  bool free = false;             ///< the parameter was estimated
  std::string note;              ///< reason why there is no interval
};

/// Prediction of one log.
struct Prediction {
  std::string log;                  ///< name of the log
  Unit unit = Unit::mm;             ///< unit of prediction and errors
  std::vector<double> time_s;       ///< times of the samples [s]
  std::vector<double> prediction;   ///< predicted reading of each sample, in `unit`
  std::vector<double> error;        ///< reading minus prediction; NaN without a reading
  double rmse = 0;                  ///< root mean square error, in `unit`
  double rmse_percent_of_span = 0;  ///< RMSE relative to the range of the readings [%]
  double largest_error = 0;         ///< largest absolute error, in `unit`
  /// The prediction is not finite, or its RMSE exceeds the range of the readings and its correlation with
  /// them is low.
  bool diverges = false;
};

/// Callback with a sentence about the present stage. It is called from any thread, but never concurrently. An
/// exception of the callback ends the computation and is passed to the caller.
using Progress = std::function<void(const std::string& stage)>;

/// Structure of the model in identify().
enum class Structure : std::uint8_t {
  start,      ///< structure of IdentifyOptions::start; without a start, the base structure
  automatic,  ///< selected on held-out blocks
  bouc_wen,   ///< selected among structures with a Bouc-Wen hysteresis
  play,       ///< selected among structures with play operators (Prandtl-Ishlinskii)
};

/// Settings of identify().
struct IdentifyOptions {
  Structure structure = Structure::start;  ///< choice of the structure
  std::optional<Model> start = {};         ///< starting point of the fit; only with Structure::start
  std::size_t branches = 2;                ///< creep branches of the base structure, 1 to 8
  std::vector<std::string> fixed = {};     ///< parameters that keep the value of `start`
  std::vector<std::string> free = {};      ///< if not empty, only these parameters are estimated
  std::size_t starts = 20;                 ///< number of starting points, 1 to 10,000
  std::uint64_t seed = 1;                  ///< seed of the starting points
  bool robust = false;                     ///< Huber loss: outliers count linearly
  double fit_share = 1;                    ///< fitted share of each log, from its start; 0.05 to 1
  unsigned threads = 0;                    ///< number of threads; 0: one per processor
  LogUse use = {};                         ///< interpretation of the logs
  std::vector<Log> validation = {};        ///< logs that are predicted but not fitted
  Progress progress = {};                  ///< callback; may be empty
  std::stop_token stop = {};               ///< can end the computation early
};

/// Result of identify().
struct Identification {
  Model model;                         ///< the identified model
  double rmse = 0;                     ///< RMSE of all fitted samples, in the unit of the model
  bool converged = false;              ///< the minimisation ended at a minimum
  std::string verdict;                 ///< assessment of the result in one sentence
  std::vector<std::string> warnings;   ///< warnings about data and result
  std::vector<Estimate> parameters;    ///< all parameters of the model
  std::vector<Estimate> combinations;  ///< properties of the finger that follow from the parameters
  std::vector<Prediction> fit;         ///< predictions of the fitted samples, by log
  std::vector<Prediction> held_out;    ///< predictions of the samples that were not fitted, by log
  std::vector<Prediction> validation;  ///< predictions of the logs in IdentifyOptions::validation
  std::string json;                    ///< identify.json of `softgrip identify`
  std::string html;                    ///< report.html of `softgrip identify`
};

/// Fits a model to logs, as `softgrip identify` does: maximum likelihood by nonlinear least squares from
/// several starting points. The intervals follow from the curvature and the correlation of the residuals.
/// Throws InvalidArgument, Refused if the logs cannot be fitted, and Cancelled.
/// @param logs     at least one log; all in the same unit
/// @param options  settings of structure, starting point and search
[[nodiscard]] SOFTGRIP_API Identification identify(const std::vector<Log>& logs,
                                                   const IdentifyOptions& options = {});

}  // namespace softgrip
