#include "tests/sysid/health/grip_fixture.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::health {
namespace {

constexpr double interval_s = 0.01;
constexpr double rest_s = 0.5, hold_s = 4, release_s = 0.5, vented_s = 3;

double command_at(double t, double rise_s) {
  const double down_s = rest_s + rise_s + hold_s;
  if (t < rest_s || t >= down_s + release_s) return 0;
  // The command rises to half of its maximum, is held, and then rises to its maximum. A single ramp would not
  // separate the lag from the gain.
  const double risen = (t - rest_s) / rise_s;
  if (risen < 1) return grip_kpa * (risen < 0.3 ? risen / 0.6 : std::max(0.5, 0.5 + (risen - 0.7) / 0.6));
  return t < down_s ? grip_kpa : grip_kpa * (1 - (t - down_s) / release_s);
}

std::vector<double> free_motion(const model::Model& model, const std::vector<double>& times, double rise_s,
                                double lag_s) {
  sysid::Log log;
  for (const double t : times) {
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(command_at(t - lag_s, rise_s));
    log.displacement_mm.push_back(0);
  }
  const auto records = sysid::make_records({log}, {.start = sysid::Start::rest, .held = true});
  return sysid::predict(model, records.front(), sysid::rest_starts(model, records).front());
}

}  // namespace

Recording grip_of(const GripWorld& world) {
  std::mt19937_64 random(world.seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.name = "grip";
  sysid::Log log;
  log.channel = "left";
  const double holding_s = rest_s + world.rise_s;
  const double end_s = holding_s + hold_s + release_s + vented_s;
  for (double t = 0; t < end_s; t += interval_s) log.time_s.push_back(t);
  const model::Model model = sysid::loaded("bench_twin");
  const std::vector<double> way = free_motion(model, log.time_s, world.rise_s, world.lag_s);
  double touched_s = NAN;
  for (std::size_t i = 0; i < log.time_s.size(); ++i) {
    const double t = log.time_s[i];
    const bool back = t > holding_s + hold_s;
    double y = world.gain * way[i] + (back && way[i] > 0.3 ? world.loop_mm : 0);
    // The object yields slightly. The contact is detected when the displacement is 1 mm smaller than the
    // displacement of a finger without contact.
    const double into_mm = std::max(0.0, y - world.object_mm);
    if (0.9 * into_mm > 1 && !std::isfinite(touched_s)) touched_s = t;
    y -= 0.9 * into_mm;
    if (t > end_s - 1) y -= world.extra_creep_mm * (t - end_s + 1);
    log.displacement_mm.push_back(y + world.zero_mm + world.noise_mm * normal(random));
    const double command = command_at(t, world.rise_s);
    log.pressure_command_kpa.push_back(command);
    const double lost = t > holding_s && !back ? world.loss_kpa + world.leak_kpa_per_s * (t - holding_s) : 0;
    if (world.measures_pressure) log.pressure_kpa.push_back(command - lost + 0.1 * normal(random));
  }
  recording.events.push_back({rest_s, "step_started", "", "0", ""});
  if (std::isfinite(touched_s)) {
    recording.events.push_back({touched_s, "contact", "left", "squeeze", ""});
    recording.events.push_back({holding_s + 0.2, "grip_result", "left", "HOLDING", ""});
    recording.events.push_back({end_s - 0.5, "grip_result", "left", "RELEASED", ""});
  }
  recording.channels.push_back(std::move(log));
  return recording;
}

}  // namespace softgrip::sysid::health
