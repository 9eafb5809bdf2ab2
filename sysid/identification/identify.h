#pragma once
// Identifies a model: estimates its parameters from logs.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/fitting/interval.h"
#include "sysid/fitting/multistart.h"
#include "sysid/fitting/score.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A value that is estimated or fixed, with its interval.
struct Estimate {
  /// Name of the value, such as "kelvin_voigt.k1_kpa_per_mm", "tp1: offset_mm" or
  /// "instantaneous_gain_mm_per_kpa".
  std::string name;
  std::string unit;
  std::string formula;  ///< formula of a combination of parameters; empty for a single parameter
  double value = 0;
  /// 95 % interval; empty if the value is fixed, at a bound, without effect, or determined only in a sum with
  /// another parameter.
  std::optional<Interval> ci95;
  std::optional<Interval> profile95;  ///< 95 % interval by profile likelihood; empty if it was not requested
                                      ///< or not found, or if the value is not a fitted model parameter
  bool free = false;
  /// True: half the width of the interval is at most half of the larger of two numbers: the magnitude of the
  /// value and its typical change. For a stiffness or damping, only the value counts.
  bool identifiable = false;
  std::string note;           ///< reason why the interval is missing; empty if there is an interval
  std::string formerly = {};  ///< deprecated name of the value, which JSON files also contain; empty: none
};

/// Results of the searches from several start points.
struct MultiStart {
  std::size_t starts = 0;
  /// Share of the start points whose search ends at an RMSE within 0.1 % of the smallest RMSE.
  double share_at_best = 0;
  std::vector<double> rmse_mm;  ///< for each start point, the RMSE at the end of its search
};
/// Returns the statistics of searches from several start points. `rmse_mm` contains the RMSE at the end of
/// each search; there must be at least one.
[[nodiscard]] MultiStart multistart_of(std::vector<double> rmse_mm);

struct IdentifyOptions {
  std::vector<std::string> fixed;  ///< paths of the parameters that keep the value of the start model
  /// Paths of the parameters that are fitted; empty: all parameters that are not fixed.
  std::vector<std::string> free;
  /// Number of start points. The start points are the given model, random points around the given model, and
  /// random points at the scale of the data.
  std::size_t starts = 20;
  std::vector<model::Model> start_points;  ///< models that are used as start points in place of the given
                                           ///< model and the random points
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< number of threads; 0: one per core
  bool robust = false;   ///< true: use Huber's loss, which is insensitive to outliers
  bool profile = false;  ///< true: also compute intervals by profile likelihood
  /// Share of the samples of each log that is fitted, counted from the start of the log. The model predicts
  /// the remaining samples, and the error of this prediction is the held-out error.
  double fit_share = 1;
  std::vector<int> exponents;  ///< Bouc-Wen exponents that are tried; empty: the exponent of the start model
  RecordOptions record;
  ShowProgress progress;
};

/// Results of the choice of a model structure by identify_structure().
struct StructureEvidence {
  /// A model structure that was compared with other structures.
  struct Candidate {
    std::string structure;  ///< "bouc_wen", "prandtl_ishlinskii" or "linear_modes"
    std::string description;
    double rmse_mm = 0;          ///< RMSE on the readings to which the structure was fitted
    double heldout_rmse_mm = 0;  ///< RMSE of held-out blocks, each predicted by a fit without this block
    bool chosen = false;
  };
  /// Result for the chosen structure after one component was removed. The reduced structure was fitted and
  /// evaluated like a candidate.
  struct Ablation {
    std::string without;
    double rmse_mm = 0;
    double heldout_rmse_mm = 0;
  };
  /// Model of the valve, from the command to the measured pressure.
  struct Valve {
    double delay_s = 0, filling_time_constant_s = 0, venting_time_constant_s = 0;
    double rmse_kpa = 0, rmse_percent_of_range = 0, held_out_rmse_kpa = 0, noise_kpa = 0;
    /// For each log, score of the prediction from the command with the models of valve and finger.
    std::vector<Score> from_command;
  };
  std::vector<Candidate> candidates;  ///< candidates in order of complexity, the simplest one first
  std::vector<Ablation> ablation;
  double ridge = 0;
  std::size_t blocks = 0;
  /// Valve model; set if the pressure was measured and the input of the model is the command.
  std::optional<Valve> valve;
};

/// Result of an identification of a model.
struct Identification {
  /// Identified model, including the blocks of the start model that are not fitted.
  model::Model model;
  /// Part of the model that is fitted, without sensor noise and quantisation.
  model::Model fitted;
  std::vector<Record> records;  ///< records of the logs; a held-out reading is NaN
  std::vector<Score> scores;    ///< for each log, the scores of its fitted samples
  /// For each log, the scores of its held-out samples; empty if no samples were held out.
  std::vector<Score> held_out;
  std::vector<Estimate> parameters;  ///< estimates of all parameters of the model
  std::vector<Estimate> combinations;
  std::vector<Estimate> starts;  ///< estimated offsets of the readings and estimated initial states
  std::vector<LooseDirection> loose;
  NoiseModel noise;          ///< autoregressive model of the residuals
  double fast_noise_mm = 0;  ///< white noise of the readings (fast_noise_mm()); the largest value of all logs
  MultiStart multistart;
  double rmse_mm = 0;  ///< RMSE of all fitted samples
  /// Width of Huber's loss; 0: the loss is the squared error.
  double huber_mm = 0;
  /// RMSE for each exponent; empty if only one exponent was fitted.
  std::vector<std::pair<int, double>> exponent_rmse_mm;
  int iterations = 0;  ///< number of iterations of the last minimisation
  bool converged = false;
  std::vector<std::string> warnings;
  double wall_s = 0;
  /// Results of the choice of the structure; set if the structure was chosen during the identification.
  std::optional<StructureEvidence> structure;
};

/// Fits the model `start` to the logs. Returns an error sentence in these cases: there is no log, a log lacks
/// the measured pressure that options.record.drive requires, the model is invalid, a parameter named in the
/// options does not exist, no parameter and no start state remains to be fitted, or no start point leads to a
/// finite prediction.
[[nodiscard]] tl::expected<Identification, std::string> identify(const std::vector<Log>& logs,
                                                                 const model::Model& start,
                                                                 const IdentifyOptions& options = {});
/// Fits the model to records. A reading that is NaN is held out.
[[nodiscard]] tl::expected<Identification, std::string> identify(std::vector<Record> records,
                                                                 const model::Model& start,
                                                                 const IdentifyOptions& options = {});

/// Returns a warning for each log whose initial state was estimated. If estimated_start(), which `validate`
/// and `diagnose` use, leads to a clearly larger error than the fitted start state, the warning states both
/// errors.
[[nodiscard]] std::vector<std::string> start_warnings(const Identification& result);

}  // namespace softgrip::sysid
