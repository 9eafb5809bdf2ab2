#pragma once
// Choice of the model structure of a finger from fixed candidates, by their error on held-out readings.

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

/// The requested structure.
enum class StructureQuestion { automatic, bouc_wen, prandtl_ishlinskii };

struct StructureChoiceOptions {
  /// The published element is rejected if the held-out error of another structure is less than this share of
  /// its own, even if the difference is uncertain; 0: never. If a cause is missing, one block may dominate
  /// the standard error.
  double published_yields_below = 0;
  StructureQuestion question = StructureQuestion::automatic;
  Drive drive = Drive::command;  ///< Drive::measured: structures without a dead time
  /// Also try a second lag and a resonance. The diagnosis treats them as causes.
  bool dynamics = false;
  std::size_t starts = 20;  ///< starting points for the published element
  /// Creep of at least this time constant is slow creep [s]; 0: from a tenth of the longest record on.
  double slow_from_s = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;  ///< callback; it can be called from any thread
};

/// Components that are removed from a structure to measure their contribution.
enum class Ingredient {
  hysteresis,
  play_operators,  ///< replaced by the Bouc-Wen element
  creep,
  slow_creep,
  pressure_dependent_creep,
  delay,
  lag,
  second_lag,
  latency,         ///< delay and lag together: each compensates for most of the other
  regulator,       ///< replaced by a lag
  venting_lag,     ///< replaced by one time constant for both directions
  characteristic,  ///< together with the envelopes: each compensates for most of the other
  resonance,
  envelopes  ///< generalised play operators, replaced by plain ones
};
inline constexpr std::array all_ingredients{Ingredient::hysteresis,
                                            Ingredient::play_operators,
                                            Ingredient::creep,
                                            Ingredient::slow_creep,
                                            Ingredient::pressure_dependent_creep,
                                            Ingredient::delay,
                                            Ingredient::lag,
                                            Ingredient::second_lag,
                                            Ingredient::latency,
                                            Ingredient::regulator,
                                            Ingredient::venting_lag,
                                            Ingredient::characteristic,
                                            Ingredient::resonance,
                                            Ingredient::envelopes};
[[nodiscard]] std::string_view name_of(Ingredient ingredient);

/// One structure, fitted to all readings. For each fold it is fitted again without the blocks of the fold,
/// which are then used for its evaluation.
struct StructureTrial {
  BaseStructure structure;
  FitPoint point;
  NonlinearNumbers numbers;  ///< empty for the published element
  double ridge = 0;
  double rmse_mm = 0;  ///< RMSE over the readings of the fit
  bool converged = false;
  bool bounded = true;     ///< see stays_bounded(); an unbounded trial is not chosen
  bool invertible = true;  ///< false: the published element has an inverse response; it is not chosen
  std::vector<double> start_rmse_mm;     ///< RMSE of the search from each starting point
  std::vector<double> block_losses_mm2;  ///< mean square error of each block while it was held out
  double heldout_rmse_mm = 0;            ///< square root of the mean of the block losses
};

struct StructureChoice {
  std::vector<StructureTrial> trials;  ///< the simplest structure is first
  std::size_t chosen = 0;
  double ridge = 0;
  std::size_t blocks = 0;
};

/// The chosen structure without one component, fitted and evaluated by the same method.
struct WithoutIngredient {
  Ingredient ingredient;
  StructureTrial trial;
};

/// Returns the records with a start at rest at the first pressure. If unknown starts have a significantly
/// lower held-out loss, returns the records unchanged. A start that the caller states is kept.
[[nodiscard]] std::vector<Record> with_simplest_start(const std::vector<Record>& records,
                                                      const StructureChoiceOptions& options);

/// Chooses the ridge parameter with the richest structure. Then chooses the simplest structure whose held-out
/// loss is within one standard error of the best (Breiman et al. 1984, section 3.4.3); the standard error is
/// that of the paired difference over blocks. Then tries extensions: with Drive::command, a second lag and a
/// regulator instead of the lags; a resonance. An extension is chosen if its held-out loss is significantly
/// lower.
[[nodiscard]] StructureChoice choose_structure(const std::vector<Record>& records,
                                               const StructureChoiceOptions& options);

/// Fits a trial that was chosen with averaged records to the original records, starting from its parameters.
/// The member `numbers` and the held-out losses remain those of the choice.
[[nodiscard]] StructureTrial fitted_to(StructureTrial trial, const std::vector<Record>& records, Drive drive);

/// Fits and evaluates the chosen structure without each of the given components that it has. Returns an empty
/// list for the published element.
/// @param records, options  as for the choice.
[[nodiscard]] std::vector<WithoutIngredient> ablation_of(
    const std::vector<Record>& records, const StructureChoice& choice, const StructureChoiceOptions& options,
    std::span<const Ingredient> ingredients = all_ingredients);

/// Fits the structure of a trial, with its ridge parameter, to other readings of the same records.
/// @param trial  without a resonance, that is, of a choice without `dynamics`.
[[nodiscard]] FitPoint fit_again(const StructureTrial& trial, const std::vector<Record>& records,
                                 Drive drive);
/// Like fit_again(), but starts only from the trial's parameters. Use it if the readings differ only
/// slightly.
[[nodiscard]] FitPoint fit_nearby(const StructureTrial& trial, const std::vector<Record>& records,
                                  Drive drive);

}  // namespace softgrip::sysid
