#pragma once
// Chooses the model structure of a finger from a fixed list of candidates. The choice depends on the errors
// of the candidates on held-out readings.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Structure that the caller requests.
enum class StructureQuestion { automatic, bouc_wen, prandtl_ishlinskii };

struct StructureChoiceOptions {
  StructureQuestion question = StructureQuestion::automatic;
  Drive drive = Drive::command;  ///< input of the structures; with Drive::measured, the structures have no
                                 ///< dead time
  /// True: a second lag, a rate limit, a resonance and linear modes are tried too. The diagnosis does not
  /// need these extensions, because it tests causes with the same effects.
  bool dynamics = false;
  std::size_t starts = 20;  ///< number of start points for the published element
  /// Smallest time constant that counts as slow creep [s]; 0: 10 % of the longest record.
  double slow_from_s = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  /// Function that receives a text about the progress. Any thread may call it.
  std::function<void(const std::string&)> progress;
};

/// One structure with its fit to all readings. For the held-out error, the structure is fitted once per fold
/// to the readings outside this fold.
struct StructureTrial {
  BaseStructure structure;
  FitPoint point;
  NonlinearNumbers numbers;  ///< nonlinear parameters; not used for the published element
  double ridge = 0;
  double rmse_mm = 0;  ///< RMSE over the readings to which the structure was fitted
  bool converged = false;
  bool bounded = true;  ///< result of stays_bounded(); false: the trial cannot be chosen
  /// False: the published element has an inverse response, so this trial cannot be chosen.
  bool invertible = true;
  std::vector<double> start_rmse_mm;  ///< RMSE at the end of the search from each start point
  /// Mean square error of each block, which was left out of the fit that predicts it. Empty: the trial was
  /// not evaluated and cannot be chosen, because its fit to all readings is not better.
  std::vector<double> block_losses_mm2;
  double heldout_rmse_mm = 0;  ///< square root of the mean of the block losses
};

struct StructureChoice {
  std::vector<StructureTrial> trials;  ///< all trials; the simplest structure comes first
  std::size_t candidates = 0;          ///< number of trials at the beginning that are candidates of the list
  std::size_t chosen = 0;
  double ridge = 0;
  std::size_t blocks = 0;
};

/// The chosen structure without one of its components. It is fitted and evaluated in the same way as the
/// chosen structure.
struct WithoutIngredient {
  Ingredient ingredient;
  StructureTrial trial;
};

/// Returns the records with the assumption that each record begins at rest at its first pressure. If unknown
/// initial states lead to a significantly lower held-out loss, returns the records unchanged. An initial
/// state that the caller specifies is not changed.
[[nodiscard]] std::vector<Record> with_simplest_start(const std::vector<Record>& records,
                                                      const StructureChoiceOptions& options);

/// Returns the index of the first trial that may be chosen and whose loss is not significantly higher than
/// the lowest loss (sysid/evidence/comparison.h; each block has the same weight). The significance does not
/// depend on the size of the largest difference. One block in which a structure fails therefore cannot hide
/// that the structure is worse.
/// @param trials  trials with the same blocks; the simplest structure comes first. At least one trial.
[[nodiscard]] std::size_t simplest_of_the_best(const std::vector<StructureTrial>& trials);

/// Chooses a structure in three steps. First, the ridge parameter is chosen with the richest structure. Then
/// simplest_of_the_best() chooses a candidate. Finally, extensions are tried: with Drive::command, a
/// regulator instead of the lags; with Drive::command and `dynamics`, a second lag and a rate limit; with
/// `dynamics`, a resonance and linear modes. If the published element has been chosen, only linear modes are
/// tried. An extension is chosen if its held-out loss is significantly lower.
[[nodiscard]] StructureChoice choose_structure(const std::vector<Record>& records,
                                               const StructureChoiceOptions& options);

/// Fits a trial to the original records. During the choice, the trial was fitted to averaged records; the new
/// fit starts at the parameters of the trial. In the result, `numbers` and the held-out losses keep their
/// values.
[[nodiscard]] StructureTrial fitted_to(StructureTrial trial, const std::vector<Record>& records, Drive drive);

/// Removes one component at a time from the chosen structure, and fits and evaluates the remaining structure.
/// Only the given components that the chosen structure contains are removed. Returns an empty list for the
/// published element.
/// @param records, options  arguments with which choose_structure() was called.
[[nodiscard]] std::vector<WithoutIngredient> ablation_of(
    const std::vector<Record>& records, const StructureChoice& choice, const StructureChoiceOptions& options,
    std::span<const Ingredient> ingredients = all_ingredients);

/// Fits the structure of a trial to modified readings of the records from which the trial was chosen. The
/// ridge parameter is that of the trial.
/// @param trial  trial without a resonance, for example from a choice without `dynamics`.
[[nodiscard]] FitPoint fit_again(const StructureTrial& trial, const std::vector<Record>& records,
                                 Drive drive);
/// Fits the structure like fit_again(), but starts the search only at the parameters of the trial. Use this
/// function if the modified readings differ little from the readings of the trial.
[[nodiscard]] FitPoint fit_nearby(const StructureTrial& trial, const std::vector<Record>& records,
                                  Drive drive);

}  // namespace softgrip::sysid
