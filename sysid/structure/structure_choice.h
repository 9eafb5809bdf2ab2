#pragma once
// Which structure a finger has: a few fixed ones, judged on readings that they were not fitted to.

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

/// What is asked for.
enum class StructureQuestion { automatic, bouc_wen, prandtl_ishlinskii };

struct StructureChoiceOptions {
  /// The published element gives way to what leaves less than this share of its held-out error, however
  /// uncertain that is; 0: to nothing. Where a cause is missing, one block may spoil what all say.
  double published_yields_below = 0;
  StructureQuestion question = StructureQuestion::automatic;
  Drive drive = Drive::command;  ///< with the measured pressure no dead time is looked for
  /// A second lag and a resonance are tried too. To the diagnosis they are causes of their own.
  bool dynamics = false;
  std::size_t starts = 20;  ///< of the published element's search
  /// Creep of at least this time constant is slow creep [s]; 0: from a tenth of the longest record on.
  double slow_from_s = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;  ///< from any thread
};

/// What a structure can be made without, to see what it brings.
enum class Ingredient {
  hysteresis,
  play_operators,  ///< instead of them Bouc-Wen's element
  creep,
  slow_creep,
  pressure_dependent_creep,
  delay,
  lag,
  second_lag,
  latency,         ///< delay and lag: each makes up for most of the other
  regulator,       ///< instead of it a lag
  venting_lag,     ///< one time constant for both directions
  characteristic,  ///< and the bend of the envelopes: each makes up for most of the other
  resonance,
  envelopes  ///< plays instead of generalised ones
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

/// One structure, fitted to everything and, fold by fold, without the blocks on which it is then judged.
struct StructureTrial {
  BaseStructure structure;
  FitPoint point;
  NonlinearNumbers numbers;  ///< empty of the published element
  double ridge = 0;
  double rmse_mm = 0;  ///< of the readings it was fitted to
  bool converged = false;
  bool bounded = true;     ///< see stays_bounded(); otherwise it is not chosen
  bool invertible = true;  ///< the published element may move the wrong way first; it is then not chosen
  std::vector<double> start_rmse_mm;     ///< where the search from each start ended
  std::vector<double> block_losses_mm2;  ///< mean square of each block while it was held out
  double heldout_rmse_mm = 0;            ///< root of their mean
};

struct StructureChoice {
  std::vector<StructureTrial> trials;  ///< the simplest first
  std::size_t chosen = 0;
  double ridge = 0;
  std::size_t blocks = 0;
};

/// The chosen structure without one of its ingredients, fitted and judged the same way.
struct WithoutIngredient {
  Ingredient ingredient;
  StructureTrial trial;
};

/// The records with a start at rest at the first pressure, all of them or none: none if unknown starts leave
/// clearly less in held-out blocks. A start that the caller states is kept.
[[nodiscard]] std::vector<Record> with_simplest_start(const std::vector<Record>& records,
                                                      const StructureChoiceOptions& options);

/// The ridge is chosen first, with the richest structure; then the simplest structure whose held-out loss is
/// within one standard error (of the difference, block by block) of the best (Breiman et al. 1984,
/// section 3.4.3). Further trials, each chosen where it loses clearly less, are a resonance and, from the
/// command, a second lag and a regulator in the place of the lags.
[[nodiscard]] StructureChoice choose_structure(const std::vector<Record>& records,
                                               const StructureChoiceOptions& options);

/// A trial that was chosen with averaged records, fitted to the records as they are, from its own numbers.
/// Its nonlinear numbers and its losses in held-out blocks stay those of the choice.
[[nodiscard]] StructureTrial fitted_to(StructureTrial trial, const std::vector<Record>& records, Drive drive);

/// The choice without each of those of the ingredients that it has: what each brings. None of the published
/// element.
/// @param records, options  those of the choice.
[[nodiscard]] std::vector<WithoutIngredient> ablation_of(
    const std::vector<Record>& records, const StructureChoice& choice, const StructureChoiceOptions& options,
    std::span<const Ingredient> ingredients = all_ingredients);

/// The same structure with the same ridge fitted to other readings of the same records.
/// @param trial  without a resonance: of a choice without `dynamics`.
[[nodiscard]] FitPoint fit_again(const StructureTrial& trial, const std::vector<Record>& records,
                                 Drive drive);
/// From the trial's own numbers alone, where what has changed of the readings is little.
[[nodiscard]] FitPoint fit_nearby(const StructureTrial& trial, const std::vector<Record>& records,
                                  Drive drive);

}  // namespace softgrip::sysid
