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
};

struct Answer {
  std::vector<double> pressure_kpa, displacement_mm;  // at the finger; before noise
};

struct World {
  ValveNumbers valve;
  FingerNumbers finger;
};

World draw_world(const std::string& make, std::uint64_t seed);
std::vector<Log> draw_campaign(std::uint64_t seed, bool poor);

/// Every log starts at rest; age, drift and the largest load run on. The valve is stepped at 0.25 ms.
std::vector<Answer> simulate(const World& world, const Effects& effects, const std::vector<Log>& logs,
                             std::uint64_t seed);

const std::vector<std::string>& library_ids();
/// What an effect's numbers are at amplitude 0 < s <= 1; the rest is drawn by the seed.
Numbers draw_effect(const std::string& id, double s, const World& world, std::uint64_t seed,
                    double campaign_s);
/// Ids that name what every world of this make has without an effect.
std::vector<std::string> own_physics(const World& world);

struct Scaled {
  Numbers numbers;
  double excess_mm = 0;
  bool reachable = true;
};
/// Measures what an effect adds to the displacement and no small change of the finger's own numbers takes
/// away.
class Excess {
 public:
  Excess(const World& world, const std::vector<Log>& logs, std::uint64_t seed);
  double of(const Effects& effects) const;
  Scaled scaled(const std::string& id, double target_mm) const;

 private:
  World world_;
  std::vector<Log> logs_;
  std::uint64_t seed_;
  std::vector<double> plain_;
  std::vector<std::vector<double>> directions_;
};

}  // namespace textbook
