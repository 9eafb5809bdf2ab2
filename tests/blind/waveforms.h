#pragma once
// What the person at the rig played: commands, temperature and supply of a campaign, drawn by seed.

#include <cstdint>
#include <vector>

#include "world.h"

namespace blind {

struct Campaign {
  std::uint64_t seed = 1;
  std::size_t runs = 3;
  double variation = 0;  // strength of the run-to-run variation (variation.h)
  double span_mm = 0;    // of the finger; needed with a variation
};

/// Logs of three kinds in turn: triangles of many amplitudes and rates with minor loops; a staircase with
/// holds and a rest; sines over a decade of rates, sharp steps, rest and repeat.
std::vector<LogInput> draw_campaign(const Campaign& campaign);

/// A log that answers a given command: the same surroundings, going on where the campaign ended.
LogInput surrounded(std::vector<double> command_kpa, double rate_hz, double campaign_start_s,
                    std::uint64_t seed);

}  // namespace blind
