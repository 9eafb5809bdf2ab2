#pragma once
// What the person at the rig played: commands, temperature and supply of a campaign, drawn by seed.

#include <cstdint>
#include <vector>

#include "world.h"

namespace blind {

/// Three logs: triangles of many amplitudes and rates with minor loops; a staircase with holds and a rest;
/// sines over a decade of rates, sharp steps, rest and repeat. `poor`: only the first log.
std::vector<LogInput> draw_campaign(std::uint64_t seed, bool poor);

/// A log that answers a given command: the same surroundings, going on where the campaign ended.
LogInput surrounded(std::vector<double> command_kpa, double rate_hz, double campaign_start_s,
                    std::uint64_t seed);

}  // namespace blind
