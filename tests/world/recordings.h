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
  std::string lack;  ///< description of the missing rows; empty: no row is missing
};

/// Checks every recording in `folder`. Between its first and its last row, a recording must contain one row
/// per channel for each tick of the loop. `ticks` contains the times of the ticks in order, relative to the
/// origin of the daemon's clock.
[[nodiscard]] RecordingsRead check_recordings(const std::string& folder,
                                              const std::vector<Nanoseconds>& ticks, std::size_t channels);

}  // namespace softgrip::world
