#pragma once
// Draws the inputs of a campaign from a seed: commands, temperature and supply pressure.

#include <cstdint>
#include <vector>

#include "world.h"

namespace blind {

struct Campaign {
  std::uint64_t seed = 1;
  std::size_t runs = 3;
  double variation = 0;  // strength of the run-to-run variation (variation.h)
  double span_mm = 0;    // span of the finger; required with a variation
};

/// Draws logs with three kinds of commands in turn: triangles with many amplitudes, rates and minor loops;
/// steps with holds and a rest; sines over a decade of rates with sharp steps, a rest and a repetition.
std::vector<LogInput> draw_campaign(const Campaign& campaign);

/// Returns a log with a given command. Temperature and supply continue where the campaign ended.
LogInput surrounded(std::vector<double> command_kpa, double rate_hz, double campaign_start_s,
                    std::uint64_t seed);

}  // namespace blind
