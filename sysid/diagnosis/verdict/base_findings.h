#pragma once
// Searches for a richer base structure (sysid/structure) if no cause explains the data on the given base
// structure. Removes each component of the richer structure in turn. A component is named if the held-out
// error increases enough without it.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

struct BaseFindings {
  StructureFit fit;  ///< fit of the richer base structure, including the causes that were found on it
  StructureTrial
      chosen;  ///< richer base structure: result of the choice, or of a later refit together with causes
  bool off_grid = false;  ///< true: `fit` was fitted to the original readings with free time constants
  std::string description;
  BlockLosses losses;                ///< losses of `fit` on the held-out blocks of the diagnosis
  std::vector<NamedCause> named;     ///< causes with an inclusion frequency of at least limits::probability
  std::vector<NamedCause> possible;  ///< causes with an inclusion frequency below limits::probability
};

struct BaseQuestion {
  Drive drive = Drive::command;
  double noise_mm = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  Division division;  ///< blocks of the diagnosis for held-out losses
  std::function<void(const std::string&)> progress;
};

/// Input of a search for a richer base structure: the data, and the causes that were selected on the given
/// base structure.
struct BaseSearch {
  const SearchData& data;
  const Selection& plain;
  const BaseQuestion& question;
};

/// Searches for a richer base structure. To test it, this structure and the given one are fitted to the first
/// half of each log, and both predict the second half. Returns nullopt if the given base structure predicts
/// about as well as the richer one and has no inverse response.
[[nodiscard]] std::optional<BaseFindings> find_base(const BaseSearch& search);

/// Limits for causes that are added to a richer base structure. No base structure matches a finger exactly.
/// An added cause can therefore reduce the error even if the finger does not have this cause.
struct CausesUpon {
  std::size_t most;  ///< largest number of causes on the richer base structure
  /// Smallest share of the mean square above the noise that all causes together must remove.
  double least_share;
  bool parts;  ///< true: if the causes remove less than `least_share`, they are reported as partial
               ///< explanations
};
inline constexpr CausesUpon upon_much_left{2, 0.3, true};
/// Limits for causes on a base structure that leaves a small error. Most of this error results from the
/// inexact equations of the structure. If the input is the command, the error of the valve model is added, so
/// the causes must remove 65 % of the error. If the input is the measured pressure, 35 % is sufficient.
inline constexpr CausesUpon upon_little_left{1, 0.65, false};
inline constexpr CausesUpon upon_little_left_measured{1, 0.35, false};

/// Searches for causes on the richer base structure and adds them to `found`.
void find_causes_upon(BaseFindings& found, const BaseSearch& search, const CausesUpon& allowed);

/// Returns true if the richer base structure with its causes has a sufficiently small held-out RMSE. The
/// limit depends on the selection on the given base structure:
/// - In general, the RMSE must be below 90 % of the RMSE of the selection.
/// - If no cause of the selection can be named, any smaller RMSE is sufficient.
/// - If the selection has an inverse response, a smaller mean square error of the fit is sufficient.
/// - If the causes are a subset of those of the selection, and the unexplained error of the selection exceeds
///   the noise, the RMSE may be up to 125 % of the RMSE of the selection.
/// @param plain_explains  true: the error of the selection is so small that its causes can be named.
[[nodiscard]] bool has_lower_loss(const BaseFindings& found, const Selection& plain, double noise_mm,
                                  bool plain_explains);

/// Returns the components that name_ingredients() can name. The argument `ablation` of that function must
/// contain one fit for each of these components, and in this fit the component is absent.
[[nodiscard]] std::vector<Ingredient> named_ingredients();

/// Tests the components of `found.chosen`. If a component reduces the error sufficiently, it becomes a named
/// cause. If the error reduction is uncertain, the component becomes a possible cause. `found.fit` must be
/// the fit of the base structure to all readings.
void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search);

}  // namespace softgrip::sysid
