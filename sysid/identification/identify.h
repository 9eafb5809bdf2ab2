#pragma once
// Identification: a model's parameters from logs.

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

/// One number that was estimated, or kept.
struct Estimate {
  std::string name;  ///< "kelvin_voigt.k1_kpa_per_mm", "tp1: offset_mm", "instantaneous_gain_mm_per_kpa"
  std::string unit;
  std::string formula;  ///< of a combination
  double value = 0;
  std::optional<Interval> ci95;       ///< none where it was fixed, stands at a bound or has no effect
  std::optional<Interval> profile95;  ///< by profile likelihood, on request
  bool free = false;
  bool identifiable = false;  ///< the interval is narrower than half the value or half a typical change
  std::string note;           ///< why there is no interval
};

/// Where the searches from several starts ended.
struct MultiStart {
  std::size_t starts = 0;
  double share_at_best = 0;     ///< within 0.1 % of the best RMSE
  std::vector<double> rmse_mm;  ///< by start
};

struct IdentifyOptions {
  std::vector<std::string> fixed;  ///< parameter paths that keep the start's value
  std::vector<std::string> free;   ///< if any: only these are free
  std::size_t starts = 20;         ///< the given one and others drawn around it and from the data's scale
  std::vector<model::Model> start_points;  ///< instead of drawn ones
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: as many as there are cores
  bool robust = false;   ///< Huber's loss, for outliers
  bool profile = false;  ///< intervals by profile likelihood besides
  /// Only the first share of every log is fitted; the rest is predicted and scored as held out.
  double fit_share = 1;
  std::vector<int> exponents;  ///< tried in turn; empty: the start's own
  RecordOptions record;
  ShowProgress progress;
};

/// What was found out about the structure, where it was not given.
struct StructureEvidence {
  /// A structure that was tried.
  struct Candidate {
    std::string structure;  ///< "bouc_wen", "prandtl_ishlinskii"
    std::string description;
    double rmse_mm = 0;          ///< of the readings it was fitted to
    double heldout_rmse_mm = 0;  ///< of interleaved blocks, each while it was not fitted
    bool chosen = false;
  };
  /// The chosen one without one of its ingredients, fitted and judged the same way.
  struct Ablation {
    std::string without;
    double rmse_mm = 0;
    double heldout_rmse_mm = 0;
  };
  /// Command to measured pressure.
  struct Valve {
    double delay_s = 0, filling_time_constant_s = 0, venting_time_constant_s = 0;
    double rmse_kpa = 0, rmse_percent_of_range = 0, held_out_rmse_kpa = 0, noise_kpa = 0;
    std::vector<Score> from_command;  ///< both stages in a row, by log
  };
  std::vector<Candidate> candidates;  ///< the simplest first
  std::vector<Ablation> ablation;
  double ridge = 0;
  std::size_t blocks = 0;
  std::optional<Valve> valve;  ///< where the pressure was measured and the command drives
};

/// The result.
struct Identification {
  model::Model model;                ///< identified, with the start's blocks that were not fitted
  model::Model fitted;               ///< the part that was fitted: without noise and quantisation
  std::vector<Record> records;       ///< as fitted: readings that were held out are missing
  std::vector<Score> scores;         ///< over the fitted samples, by log
  std::vector<Score> held_out;       ///< over the others, by log; empty if all were fitted
  std::vector<Estimate> parameters;  ///< all of the model
  std::vector<Estimate> combinations;
  std::vector<Estimate> starts;  ///< offsets and start states that were estimated
  std::vector<LooseDirection> loose;
  NoiseModel noise;          ///< of the residuals
  double fast_noise_mm = 0;  ///< of the readings, sample to sample
  MultiStart multistart;
  double rmse_mm = 0;                                    ///< of all fitted samples
  double huber_mm = 0;                                   ///< 0: not robust
  std::vector<std::pair<int, double>> exponent_rmse_mm;  ///< where several were tried
  int iterations = 0;                                    ///< of the last minimisation
  bool converged = false;
  std::vector<std::string> warnings;
  double wall_s = 0;
  std::optional<StructureEvidence> structure;  ///< where the structure was chosen
};

/// The base structure (Bouc-Wen, Kelvin-Voigt with `branches` branches) with values from the data's scale.
[[nodiscard]] model::Model base_model(const std::vector<Log>& logs, std::size_t branches);
[[nodiscard]] model::Model base_model(const std::vector<Record>& records, std::size_t branches);

/// Fits `start` to the logs. Fails with a sentence: a parameter that does not exist, nothing to fit, a model
/// that is nowhere defined.
[[nodiscard]] tl::expected<Identification, std::string> identify(const std::vector<Log>& logs,
                                                                 const model::Model& start,
                                                                 const IdentifyOptions& options = {});
/// The same for records that are there already: what is hidden in them stays hidden.
[[nodiscard]] tl::expected<Identification, std::string> identify(std::vector<Record> records,
                                                                 const model::Model& start,
                                                                 const IdentifyOptions& options = {});

}  // namespace softgrip::sysid
