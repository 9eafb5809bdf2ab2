#pragma once
// Simulates worlds with textbook equations. A world consists of a valve, a finger, hidden effects and a
// campaign of logs. A seed determines all of them.

#include <cstdint>
#include <string>
#include <vector>

#include "finger.h"
#include "valve.h"
#include "world_program.h"

namespace textbook {

using worlds::Answer, worlds::Effects, worlds::Log, worlds::Numbers;
using worlds::drop_unrecorded, worlds::duration_s;

struct World {
  ValveNumbers valve;
  FingerNumbers finger;
  bool perfect_valve = false;  // true: the pressure equals the command
};

World draw_world(const std::string& make, std::uint64_t seed);
struct Campaign {
  std::uint64_t seed = 1;
  std::size_t runs = 3;
  double rate_hz = 100;
  double variation = 0;  // strength of the run-to-run variation (variation.h)
  double span_mm = 0;    // span of the finger [mm]; required if variation is above 0
};

/// Draws logs with three kinds of commands in turn: triangles, steps, and sums of sines.
std::vector<Log> draw_campaign(const Campaign& campaign);

/// Simulates all logs. Every log starts at rest; the age, the drift and the largest load of the finger
/// continue from log to log. The time step of the valve is 0.25 ms.
std::vector<Answer> simulate(const World& world, const Effects& effects, const std::vector<Log>& logs,
                             std::uint64_t seed);

/// Computes the pressures at the finger for each log. This computation takes most of the time of a
/// simulation. Its result is valid for all effects that do not change the pressure.
using Pressures = std::vector<std::vector<double>>;  // gauge pressures [kPa], one list per log
Pressures simulate_pressures(const World& world, const Effects& effects, const std::vector<Log>& logs);
bool acts_on_pressure(const Effects& effects);

/// Simulates the finger with these pressures. Returns the displacements of all logs in one list.
std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed, const Pressures& pressures);
std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed);

/// Data that determine the parameters of an effect: the world, its largest displacement and the duration of
/// the campaign.
struct Setting {
  World world;
  double largest_mm = 0;  // largest displacement of the campaign without effects [mm]
  double campaign_s = 0;
};

const std::vector<std::string>& library_ids();
/// Returns the parameters of an effect. Amplitude `s` is between 0 and 1; 1 is the largest physical size. The
/// parameters that do not depend on the amplitude are drawn from the seed.
Numbers draw_effect(const std::string& id, double s, const Setting& setting, std::uint64_t seed);

}  // namespace textbook
