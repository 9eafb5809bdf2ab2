#pragma once
// Structure is a finding too: where no cause on the given base explains the data, a richer base is looked for
// (sysid/structure), and each of its ingredients that gains on held-out blocks is named.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/verdict/named_cause.h"

namespace softgrip::sysid {

struct BaseFindings {
  StructureFit fit;  ///< the richer base, without causes
  std::string description;
  BlockLosses losses;                ///< on interleaved blocks, each while it was held out
  BlockLosses recalibrated_losses;   ///< of the given base on the same blocks
  std::vector<NamedCause> named;     ///< at full inclusion
  std::vector<NamedCause> possible;  ///< below it
};

struct BaseQuestion {
  Drive drive = Drive::command;
  double noise_mm = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// Nothing where no richer base leaves clearly less, on the same blocks, than what was reached with causes on
/// the given one.
[[nodiscard]] std::optional<BaseFindings> find_base(const SearchData& data, const StructureFit& recalibrated,
                                                    const StructureFit& reached,
                                                    const BaseQuestion& question);

}  // namespace softgrip::sysid
