#pragma once
// Searches for a richer base if no cause on the given base explains the data (sysid/structure). Each
// component of it that reduces the held-out error is named.

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
  StructureFit fit;       ///< the richer base, with the causes that were found on it
  StructureTrial chosen;  ///< the richer base as it was found, or as it is together with causes
  bool off_grid = false;  ///< `fit` uses the original readings and has free time constants
  std::string description;
  BlockLosses losses;                ///< held-out losses on the given division
  std::vector<NamedCause> named;     ///< causes at full inclusion
  std::vector<NamedCause> possible;  ///< causes below full inclusion
};

struct BaseQuestion {
  Drive drive = Drive::command;
  double noise_mm = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  Division division;  ///< held-out blocks
  std::function<void(const std::string&)> progress;
};

/// Inputs of a search for a base, with the selection on the given base.
struct BaseSearch {
  const SearchData& data;
  const Selection& plain;
  const BaseQuestion& question;
};

/// Returns an empty value if no richer base predicts the readings after the fitted ones significantly better
/// than the given base.
[[nodiscard]] std::optional<BaseFindings> find_base(const BaseSearch& search);

/// Limits for causes on a richer base. No base matches a finger exactly, and a cause can absorb part of the
/// difference.
struct CausesUpon {
  std::size_t most;    ///< largest number of causes
  double least_share;  ///< smallest share of the base's remaining mean square that they must remove together
  bool parts;          ///< causes that remove less are reported as partial explanations
};
inline constexpr CausesUpon upon_much_left{2, 0.3, true};
/// If the base leaves little error, most of it is due to its form. With the command as input, the form of the
/// valve contributes too.
inline constexpr CausesUpon upon_little_left{1, 0.65, false};
inline constexpr CausesUpon upon_little_left_measured{1, 0.35, false};

/// Continues the search for causes on a richer base, and adds its results.
void find_causes_upon(BaseFindings& found, const BaseSearch& search, const CausesUpon& allowed);

/// Returns true if the richer base and its causes have a significantly lower held-out loss than the selection
/// on the given base. An equal loss is sufficient if the selection is unphysical. A slightly higher loss is
/// sufficient with a subset of the same causes, if the selection leaves more than the noise.
/// @param plain_explains  true if the selection on the given base leaves little enough to be named.
[[nodiscard]] bool has_lower_loss(const BaseFindings& found, const Selection& plain, double noise_mm,
                                  bool plain_explains);

}  // namespace softgrip::sysid
