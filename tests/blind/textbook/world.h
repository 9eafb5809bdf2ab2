#pragma once
// Worlds of textbook physics: a valve, a finger, effects on top, a campaign of logs, all drawn by a seed.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "finger.h"
#include "valve.h"

namespace textbook {

using Numbers = std::map<std::string, double>;
using Effects = std::map<std::string, Numbers>;

struct Log {
  double rate_hz = 100;
  std::vector<double> command_kpa, temperature_c, supply_kpa;  // one value per sample, gauge
  // Run-to-run variation (variation.h).
  double gain = 1, offset_mm = 0;
  std::size_t unrecorded = 0;  // first samples, before the recording begins
  // Closed loop: a controller follows the reference from the first recorded sample on. Its sensor adds
  // `noise_mm`, one value per recorded sample.
  std::vector<double> reference_mm, noise_mm;
};

struct Answer {
  std::vector<double> command_kpa, pressure_kpa, displacement_mm;  // as played; at the finger; before noise
};

struct World {
  ValveNumbers valve;
  FingerNumbers finger;
  bool perfect_valve = false;  // the pressure is the command
};

World draw_world(const std::string& make, std::uint64_t seed);
struct Campaign {
  std::uint64_t seed = 1;
  std::size_t runs = 3;
  double rate_hz = 100;
  double variation = 0;  // strength of the run-to-run variation (variation.h)
  double span_mm = 0;    // of the finger; needed with a variation
};

/// Logs of three kinds in turn: triangles, stairs, sines on sines.
std::vector<Log> draw_campaign(const Campaign& campaign);
/// Removes the unrecorded samples of a log.
void drop_unrecorded(Log& log, Answer& answer);
double duration_s(const std::vector<Log>& logs);

/// Every log starts at rest; age, drift and the largest load run on. The valve is stepped at 0.25 ms.
std::vector<Answer> simulate(const World& world, const Effects& effects, const std::vector<Log>& logs,
                             std::uint64_t seed);

/// The pressures at the finger alone, log by log: what takes most of a simulation's time, and is the same
/// under every effect that does not act on pressure.
using Pressures = std::vector<std::vector<double>>;  // gauge, kPa
Pressures simulate_pressures(const World& world, const Effects& effects, const std::vector<Log>& logs);
bool acts_on_pressure(const Effects& effects);

/// The displacements of all logs under such pressures, one after the other.
std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed, const Pressures& pressures);
std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed);

/// What an effect may be drawn for: the world, how far it moves and how long it is watched.
struct Setting {
  World world;
  double largest_mm = 0;  // of its campaign, without effects
  double campaign_s = 0;
};

const std::vector<std::string>& library_ids();
/// What an effect's numbers are at amplitude 0 < s <= 1; the rest is drawn by the seed.
Numbers draw_effect(const std::string& id, double s, const Setting& setting, std::uint64_t seed);

}  // namespace textbook
