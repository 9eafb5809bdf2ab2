#pragma once
// Chooses the model structure of a finger. The candidates are fixed, and their errors on held-out readings
// decide.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/structure/ingredient.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Structure that the caller requests.
enum class StructureQuestion { automatic, bouc_wen, prandtl_ishlinskii };

struct StructureChoiceOptions {
  /// The published element is rejected if the ratio of another structure's held-out error to its own error is
  /// below this value, even if the difference is not significant. 0: this rule is not applied. If all
  /// structures lack a cause, one block may dominate the standard error and make the difference
  /// insignificant.
  double published_yields_below = 0;
  StructureQuestion question = StructureQuestion::automatic;
  Drive drive = Drive::command;  ///< input of the structures; with Drive::measured, they have no dead time
  /// True: a second lag and a resonance are tried too. The diagnosis does not need these extensions, because
  /// it treats them as causes.
  bool dynamics = false;
  std::size_t starts = 20;  ///< number of start points for the published element
  /// Time constant from which creep counts as slow creep [s]; 0: 10 % of the longest record.
  double slow_from_s = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  /// Called with a text that states the progress, from any thread.
  std::function<void(const std::string&)> progress;
};

/// One structure, fitted to all readings. For the held-out error, it is fitted again for each fold without
/// the blocks of this fold.
struct StructureTrial {
  BaseStructure structure;
  FitPoint point;
  NonlinearNumbers numbers;  ///< nonlinear parameters; not used for the published element
  double ridge = 0;
  double rmse_mm = 0;  ///< RMSE over the readings to which the structure was fitted
  bool converged = false;
  bool bounded = true;  ///< result of stays_bounded(); a trial that is not bounded cannot be chosen
  /// False: the published element has an inverse response, so the trial cannot be chosen.
  bool invertible = true;
  std::vector<double> start_rmse_mm;  ///< RMSE of the search from each start point
  /// Mean square error of each block, predicted by a fit without this block.
  std::vector<double> block_losses_mm2;
  double heldout_rmse_mm = 0;  ///< square root of the mean of the block losses
};

struct StructureChoice {
  std::vector<StructureTrial> trials;  ///< all trials; the simplest structure comes first
  std::size_t chosen = 0;
  double ridge = 0;
  std::size_t blocks = 0;
};

/// The chosen structure after removal of one component, fitted and evaluated like the chosen structure.
struct WithoutIngredient {
  Ingredient ingredient;
  StructureTrial trial;
};

/// Returns the records under the assumption that each of them begins at rest at its first pressure. If the
/// held-out loss is significantly lower with unknown initial states, returns the records unchanged. An
/// initial state that the caller specifies is not changed.
[[nodiscard]] std::vector<Record> with_simplest_start(const std::vector<Record>& records,
                                                      const StructureChoiceOptions& options);

/// Chooses a structure in three steps. First, the ridge parameter is chosen with the richest structure. Then
/// the simplest structure is chosen whose held-out loss is within one standard error of the lowest one
/// (Breiman et al. 1984, section 3.4.3). The standard error is that of the paired difference over blocks.
/// Finally, extensions are tried. With Drive::command, these are a second lag (with `dynamics` only) and a
/// regulator instead of the lags; with `dynamics`, a resonance and linear modes are tried as well. An
/// extension is chosen if its held-out loss is significantly lower.
[[nodiscard]] StructureChoice choose_structure(const std::vector<Record>& records,
                                               const StructureChoiceOptions& options);

/// Fits a trial to the original records, starting at its parameters. The trial was chosen with averaged
/// records. Its member `numbers` and its held-out losses keep the values of the choice.
[[nodiscard]] StructureTrial fitted_to(StructureTrial trial, const std::vector<Record>& records, Drive drive);

/// For each of the given components that the chosen structure contains, fits and evaluates the structure
/// without this component. Returns an empty list for the published element.
/// @param records, options  the arguments of choose_structure().
[[nodiscard]] std::vector<WithoutIngredient> ablation_of(
    const std::vector<Record>& records, const StructureChoice& choice, const StructureChoiceOptions& options,
    std::span<const Ingredient> ingredients = all_ingredients);

/// Fits the structure of a trial, with the ridge parameter of the trial, to modified readings of the same
/// records.
/// @param trial  trial without a resonance, that is, from a choice without `dynamics`.
[[nodiscard]] FitPoint fit_again(const StructureTrial& trial, const std::vector<Record>& records,
                                 Drive drive);
/// Fits the structure like fit_again(), but the search starts only at the parameters of the trial. Use this
/// function if the readings differ little from the readings of the trial.
[[nodiscard]] FitPoint fit_nearby(const StructureTrial& trial, const std::vector<Record>& records,
                                  Drive drive);

}  // namespace softgrip::sysid
