#pragma once
// Whether the recordings of a daemon hold every tick that they should.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace softgrip::world {

struct RecordingsRead {
  std::uint64_t rows = 0;
  std::string lack;  ///< what is not there; empty: nothing
};

/// `ticks`: when the loop ticked, since the daemon's origin, in order. Every recording in `folder` must hold
/// a row per channel of each tick between its first and its last.
[[nodiscard]] RecordingsRead check_recordings(const std::string& folder,
                                              const std::vector<Nanoseconds>& ticks, std::size_t channels);

}  // namespace softgrip::world
