#pragma once
// Draws the inputs of a campaign: commands, temperature and supply pressure. A seed determines the random
// values.

#include <cstdint>
#include <vector>

#include "world.h"

namespace blind {

struct Campaign {
  std::uint64_t seed = 1;
  std::size_t runs = 3;
  double variation = 0;  // strength of the run-to-run variation (variation.h)
  double span_mm = 0;    // span of the finger [mm]; required if variation is above 0
};

/// Draws logs with three kinds of commands in turn. The first kind consists of triangles with many
/// amplitudes, rates and minor loops. The second kind consists of steps with holds and a rest. The third kind
/// consists of sines over a decade of rates, sharp steps, a rest and a repetition.
std::vector<LogInput> draw_campaign(const Campaign& campaign);

/// Returns a log with a given command. The temperature and the supply pressure continue from their values at
/// the end of the campaign.
LogInput surrounded(std::vector<double> command_kpa, double rate_hz, double campaign_start_s,
                    std::uint64_t seed);

}  // namespace blind
