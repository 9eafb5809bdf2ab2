#pragma once
// Identifies a model: estimates its parameters from logs.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/fitting/interval.h"
#include "sysid/fitting/score.h"
#include "sysid/fitting/search.h"
#include "sysid/identification/noise_model.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// One estimated or fixed value.
struct Estimate {
  std::string name;  ///< "kelvin_voigt.k1_kpa_per_mm", "tp1: offset_mm", "instantaneous_gain_mm_per_kpa"
  std::string unit;
  std::string formula;  ///< formula if the value is a combination of parameters, otherwise empty
  double value = 0;
  std::optional<Interval> ci95;       ///< empty if the value is fixed, at a bound or without effect
  std::optional<Interval> profile95;  ///< interval by profile likelihood; empty if it was not requested
  bool free = false;
  bool identifiable = false;  ///< true: half the interval is at most half the value or half a typical change
  std::string note;           ///< reason why there is no interval; empty if there is one
};

/// Results of searches from several start points.
struct MultiStart {
  std::size_t starts = 0;
  double share_at_best = 0;     ///< share of the start points from which the search ends within 0.1 % of the
                                ///< best RMSE
  std::vector<double> rmse_mm;  ///< RMSE at the end of the search from each start point
};

struct IdentifyOptions {
  std::vector<std::string> fixed;  ///< parameter paths that keep the value of the start model
  std::vector<std::string> free;   ///< parameter paths that are fitted; empty: all that are not fixed
  std::size_t starts = 20;  ///< number of start points: the given model, and points drawn around it and from
                            ///< the scale of the data
  std::vector<model::Model> start_points;  ///< models to start from instead of random start points
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: one per core
  bool robust = false;   ///< use Huber's loss, which is insensitive to outliers
  bool profile = false;  ///< also compute intervals by profile likelihood
  /// Share of every log, from its start, that is fitted. The rest is predicted and scored as held-out data.
  double fit_share = 1;
  std::vector<int> exponents;  ///< Bouc-Wen exponents to try; empty: that of the start model
  RecordOptions record;
  ShowProgress progress;
};

/// Results of the choice of a structure, which is made if the caller specifies none.
struct StructureEvidence {
  /// A structure that was fitted for comparison.
  struct Candidate {
    std::string structure;  ///< "bouc_wen", "prandtl_ishlinskii"
    std::string description;
    double rmse_mm = 0;          ///< RMSE on the fitted readings
    double heldout_rmse_mm = 0;  ///< RMSE on interleaved blocks, each predicted by a fit without this block
    bool chosen = false;
  };
  /// The chosen structure without one component, fitted and evaluated in the same way.
  struct Ablation {
    std::string without;
    double rmse_mm = 0;
    double heldout_rmse_mm = 0;
  };
  /// Model from the command to the measured pressure.
  struct Valve {
    double delay_s = 0, filling_time_constant_s = 0, venting_time_constant_s = 0;
    double rmse_kpa = 0, rmse_percent_of_range = 0, held_out_rmse_kpa = 0, noise_kpa = 0;
    std::vector<Score> from_command;  ///< prediction of each log from the command through the valve model and
                                      ///< the model of the finger
  };
  std::vector<Candidate> candidates;  ///< candidates, the simplest first
  std::vector<Ablation> ablation;
  double ridge = 0;
  std::size_t blocks = 0;
  std::optional<Valve> valve;  ///< present if the pressure was measured and the command drives the model
};

/// Result of an identification.
struct Identification {
  model::Model model;                ///< identified model, including the blocks of the start model that were
                                     ///< not fitted
  model::Model fitted;               ///< fitted part of the model, without noise and quantisation
  std::vector<Record> records;       ///< fitted records, in which held-out readings are NaN
  std::vector<Score> scores;         ///< scores of the fitted samples of each log
  std::vector<Score> held_out;       ///< scores of the held-out samples of each log; empty if all samples
                                     ///< were fitted
  std::vector<Estimate> parameters;  ///< all parameters of the model
  std::vector<Estimate> combinations;
  std::vector<Estimate> starts;  ///< estimated offsets and initial states
  std::vector<LooseDirection> loose;
  NoiseModel noise;          ///< noise model of the residuals
  double fast_noise_mm = 0;  ///< noise of the readings between consecutive samples
  MultiStart multistart;
  double rmse_mm = 0;                                    ///< RMSE of all fitted samples
  double huber_mm = 0;                                   ///< width of Huber's loss; 0: this loss was not used
  std::vector<std::pair<int, double>> exponent_rmse_mm;  ///< RMSE for each exponent; empty unless several
                                                         ///< exponents were fitted
  int iterations = 0;                                    ///< iterations of the last minimisation
  bool converged = false;
  std::vector<std::string> warnings;
  double wall_s = 0;
  std::optional<StructureEvidence> structure;  ///< present if the structure was chosen during the
                                               ///< identification
};

/// Returns the default structure (Bouc-Wen and Kelvin-Voigt with `branches` branches) with values at the
/// scale of the data.
[[nodiscard]] model::Model base_model(const std::vector<Log>& logs, std::size_t branches);
[[nodiscard]] model::Model base_model(const std::vector<Record>& records, std::size_t branches);

/// Fits the model `start` to the logs. Returns an error sentence if a named parameter does not exist, if no
/// parameter is to be fitted, or if the model is not defined at any start point.
[[nodiscard]] tl::expected<Identification, std::string> identify(const std::vector<Log>& logs,
                                                                 const model::Model& start,
                                                                 const IdentifyOptions& options = {});
/// Fits the model to existing records. Readings that are NaN are held out.
[[nodiscard]] tl::expected<Identification, std::string> identify(std::vector<Record> records,
                                                                 const model::Model& start,
                                                                 const IdentifyOptions& options = {});

}  // namespace softgrip::sysid
