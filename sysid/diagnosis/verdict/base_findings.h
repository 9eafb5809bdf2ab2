#pragma once
// Searches for a richer base structure (sysid/structure) if no cause on the given base structure explains the
// data. Each component of the richer structure that reduces the held-out error is named.

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
  StructureFit fit;  ///< the richer base structure with the causes that were found on it
  StructureTrial
      chosen;  ///< the richer base structure as it was chosen first, or as refitted together with causes
  bool off_grid = false;  ///< true: `fit` uses the original readings and has free time constants
  std::string description;
  BlockLosses losses;                ///< losses on the held-out blocks of the diagnosis
  std::vector<NamedCause> named;     ///< causes with full_inclusion or more
  std::vector<NamedCause> possible;  ///< causes with less than full_inclusion
};

struct BaseQuestion {
  Drive drive = Drive::command;
  double noise_mm = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  Division division;  ///< held-out blocks
  std::function<void(const std::string&)> progress;
};

/// Inputs of a search for a base structure, with the selection on the given base structure.
struct BaseSearch {
  const SearchData& data;
  const Selection& plain;
  const BaseQuestion& question;
};

/// Returns an empty value unless a richer base structure, fitted to the first halves of the logs, predicts
/// the second halves significantly better than the given base structure.
[[nodiscard]] std::optional<BaseFindings> find_base(const BaseSearch& search);

/// Limits for causes on a richer base structure. No base structure matches a finger exactly, and a cause can
/// absorb part of the difference.
struct CausesUpon {
  std::size_t most;    ///< maximum number of causes
  double least_share;  ///< smallest share of the mean square left by the base structure that the causes must
                       ///< remove together
  bool parts;          ///< true: causes that remove less than this share are reported as partial explanations
};
inline constexpr CausesUpon upon_much_left{2, 0.3, true};
/// Limits if the base structure leaves little error. Most of that error is due to the inexact form of the
/// structure. With the command as input, the form of the valve model contributes as well, so that limit is
/// stricter.
inline constexpr CausesUpon upon_little_left{1, 0.65, false};
inline constexpr CausesUpon upon_little_left_measured{1, 0.35, false};

/// Continues the search for causes on a richer base structure and adds its results to `found`.
void find_causes_upon(BaseFindings& found, const BaseSearch& search, const CausesUpon& allowed);

/// Returns true if the richer base structure and its causes have a held-out RMSE of less than 90 % of that of
/// the selection on the given base structure. Any lower RMSE is sufficient if nothing can be named on the
/// given base structure. Any lower mean square is sufficient if the selection is unphysical. Up to 125 % of
/// the RMSE is sufficient if the causes are a proper subset of those of the selection and the selection
/// leaves more than the noise.
/// @param plain_explains  true if the error left by the selection is small enough for its causes to be named.
[[nodiscard]] bool has_lower_loss(const BaseFindings& found, const Selection& plain, double noise_mm,
                                  bool plain_explains);

}  // namespace softgrip::sysid
