#pragma once
// Structure is a finding too: where no cause on the given base explains the data, a richer base is looked for
// (sysid/structure), and each of its ingredients that gains on held-out blocks is named.

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
  StructureTrial chosen;  ///< the richer base, as it was found or as it is beside causes
  bool off_grid = false;  ///< `fit` is of the readings as they are, its time constants where they are best
  std::string description;
  BlockLosses losses;                ///< held out, on the division that was asked for
  std::vector<NamedCause> named;     ///< at full inclusion
  std::vector<NamedCause> possible;  ///< below it
};

struct BaseQuestion {
  Drive drive = Drive::command;
  double noise_mm = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  Division division;  ///< of held-out blocks
  std::function<void(const std::string&)> progress;
};

/// Where a base is looked for, and what was selected on the given one.
struct BaseSearch {
  const SearchData& data;
  const Selection& plain;
  const BaseQuestion& question;
};

/// Nothing where no richer base foretells clearly better than the given one what comes after the readings
/// that both were fitted to.
[[nodiscard]] std::optional<BaseFindings> find_base(const BaseSearch& search);

/// What may stand upon a richer base. No base is a finger's own, and what makes up for that takes a part.
struct CausesUpon {
  std::size_t most;    ///< so many causes
  double least_share;  ///< of what the base leaves, as a mean square, they must take together
  bool parts;          ///< those that take less are told as a part of it
};
inline constexpr CausesUpon upon_much_left{2, 0.3, true};
/// Where the base leaves little, its form is most of it; from the command, the valve's too.
inline constexpr CausesUpon upon_little_left{1, 0.65, false};
inline constexpr CausesUpon upon_little_left_measured{1, 0.35, false};

/// Goes on with the search for causes upon a richer base, and adds what it finds.
void find_causes_upon(BaseFindings& found, const BaseSearch& search, const CausesUpon& allowed);

/// Whether a richer base, with what stands upon it, leaves clearly less held out than what was selected on
/// the given one; or as little, where that is unphysical; or not much more with some of the same causes,
/// where that leaves more than the noise.
/// @param plain_explains  whether the selection on the given base leaves little enough to be named.
[[nodiscard]] bool outdoes(const BaseFindings& found, const Selection& plain, double noise_mm,
                           bool plain_explains);

}  // namespace softgrip::sysid
