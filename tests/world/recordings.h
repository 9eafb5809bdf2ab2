#pragma once
// Checks that the recordings of a daemon contain a row for every tick.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace softgrip::world {

struct RecordingsRead {
  std::uint64_t rows = 0;
  std::string lack;  ///< the missing rows; empty if none are missing
};

/// `ticks`: the times of the loop's ticks since the daemon's origin, in order. Every recording in `folder`
/// must contain one row per channel for each tick between its first and its last row.
[[nodiscard]] RecordingsRead check_recordings(const std::string& folder,
                                              const std::vector<Nanoseconds>& ticks, std::size_t channels);

}  // namespace softgrip::world
