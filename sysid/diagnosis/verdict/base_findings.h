#pragma once
// Searches for a richer base structure (sysid/structure) if no cause explains the data on the given base
// structure. Names each component of the richer base structure that reduces the held-out error.
// Removes each component of a richer base structure, measures how much the error increases, and names the
// components whose removal increases the error.

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
  StructureFit fit;  ///< fit of the richer base structure with the causes that were found on it
  StructureTrial
      chosen;  ///< richer base structure as it was chosen, or as it was later refitted together with causes
  bool off_grid = false;  ///< true: `fit` was fitted to the original readings with free time constants
  std::string description;
  BlockLosses losses;                ///< losses of `fit` on the held-out blocks of the diagnosis
  std::vector<NamedCause> named;     ///< causes whose inclusion frequency is at least limits::probability
  std::vector<NamedCause> possible;  ///< causes whose inclusion frequency is below limits::probability
};

struct BaseQuestion {
  Drive drive = Drive::command;
  double noise_mm = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  Division division;  ///< held-out blocks of the diagnosis
  std::function<void(const std::string&)> progress;
};

/// Input of a search for a base structure: the data, and the selection on the given base structure.
struct BaseSearch {
  const SearchData& data;
  const Selection& plain;
  const BaseQuestion& question;
};

/// Searches for a richer base structure. It is fitted to the first half of each log. Returns nullopt if the
/// given base structure predicts the second halves about as well as the richer one and has no inverse
/// response.
[[nodiscard]] std::optional<BaseFindings> find_base(const BaseSearch& search);

/// Limits for causes that are added to a richer base structure. No base structure matches a finger exactly,
/// and a cause can absorb part of the resulting error.
struct CausesUpon {
  std::size_t most;  ///< maximum number of causes on the richer base structure
  /// Smallest share of the mean square of the base structure that all causes together must remove.
  double least_share;
  bool parts;  ///< true: causes that remove less than `least_share` are reported as partial explanations
};
inline constexpr CausesUpon upon_much_left{2, 0.3, true};
/// Limits for causes on a base structure that leaves a small error. Most of this error is due to the inexact
/// equations of the structure. If the input is the command, the inexact valve model adds to the error, so the
/// causes must remove 65 % of it. If the input is the measured pressure, they must remove 35 %.
inline constexpr CausesUpon upon_little_left{1, 0.65, false};
inline constexpr CausesUpon upon_little_left_measured{1, 0.35, false};

/// Continues the search for causes on a richer base structure. Adds the causes to `found`.
void find_causes_upon(BaseFindings& found, const BaseSearch& search, const CausesUpon& allowed);

/// Returns true if the richer base structure and its causes have a sufficiently low held-out RMSE compared
/// with the selection on the given base structure. The following limits apply:
/// - In general, the RMSE must be below 90 % of the RMSE of the selection.
/// - If nothing can be named on the given base structure, any lower RMSE is sufficient.
/// - If the selection is unphysical, any lower mean square is sufficient.
/// - If the causes are some of those of the selection, and the selection leaves more than the noise, up to
///   125 % of its RMSE is sufficient.
/// @param plain_explains  true: the error of the selection is so small that its causes can be named.
[[nodiscard]] bool has_lower_loss(const BaseFindings& found, const Selection& plain, double noise_mm,
                                  bool plain_explains);

/// Returns the components that name_ingredients() can name. For each of them, name_ingredients() needs a fit
/// without this component.
[[nodiscard]] std::vector<Ingredient> named_ingredients();

/// Tests the components of `found.chosen`. A component that reduces the error sufficiently becomes a named
/// cause. A component whose error reduction is uncertain becomes a possible cause. `found.fit` must be the
/// base structure fitted to all readings.
void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search);

}  // namespace softgrip::sysid
