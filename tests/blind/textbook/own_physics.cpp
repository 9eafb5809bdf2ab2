#include "own_physics.h"

#include <algorithm>
#include <cmath>

#include "strength.h"

namespace textbook {
namespace {

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

struct SettledLoop {
  double bend_mm = 0, asymmetry_mm = 0;
};

// The second loop to working pressure of the finger that does not creep.
SettledLoop settled_loop(FingerNumbers numbers) {
  numbers.creep = 0;
  Finger finger(numbers);
  constexpr int steps = 400;
  std::vector<double> up(steps + 1, 0), down(steps + 1, 0);
  for (int loop = 0; loop < 2; ++loop) {
    for (int i = 0; i <= steps; ++i)
      up[static_cast<std::size_t>(i)] = finger.step(working_kpa * i / steps, 0.01);
    for (int i = steps; i >= 0; --i)
      down[static_cast<std::size_t>(i)] = finger.step(working_kpa * i / steps, 0.01);
  }
  std::vector<double> place, middle, skew;
  for (std::size_t i = 0; i <= steps; ++i) {
    place.push_back(static_cast<double>(i));
    middle.push_back((up[i] + down[i]) / 2);
    skew.push_back((down[i] - up[i] - down[steps - i] + up[steps - i]) / 4);
  }
  return {Recalibration(place).left_mm(middle), rms(skew)};
}

// RMS [kPa] of the valve's pressure against the command behind a dead time and a first-order lag.
double lag_miss_kpa(const std::vector<Log>& logs, const std::vector<Answer>& answers, double tau_s,
                    int delay) {
  double sum = 0, count = 0;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const double share = -std::expm1(-1 / (logs[l].rate_hz * tau_s));
    double lagged = 0;
    for (std::size_t k = 0; k < answers[l].pressure_kpa.size(); ++k, ++count) {
      const double miss = answers[l].pressure_kpa[k] - lagged;
      sum += miss * miss;
      const std::size_t then = k - std::min(k, static_cast<std::size_t>(delay));
      lagged += (logs[l].command_kpa[then] - lagged) * share;
    }
  }
  return std::sqrt(sum / count);
}

double dead_time_kpa(const std::vector<Log>& logs, const std::vector<Answer>& answers) {
  double lag = 1e9, both = 1e9;
  for (int delay = 0; delay <= 8; ++delay) {
    for (double tau_s = 0.003; tau_s < 0.5; tau_s *= 1.15) {
      const double miss = lag_miss_kpa(logs, answers, tau_s, delay);
      both = std::min(both, miss);
      if (delay == 0) lag = std::min(lag, miss);
    }
  }
  return std::sqrt(std::max(0.0, lag * lag - both * both));
}

}  // namespace

std::map<std::string, double> own_physics(const World& world, const std::vector<Log>& logs,
                                          std::uint64_t seed, double visible_mm) {
  const auto plain = displacements(world, {}, logs, seed);
  const Recalibration zero_and_gain(plain);
  const auto against = [&](const World& other, const std::vector<Log>& other_logs) {
    auto change = displacements(other, {}, other_logs, seed);
    for (std::size_t k = 0; k < change.size(); ++k) change[k] -= plain[k];
    return zero_and_gain.left_mm(change);
  };
  World quick = world, loopless = world, perfect = world, willing = world;
  quick.finger.longest_creep_s = slowest_twin_s;
  loopless.finger.width = 0;
  perfect.perfect_valve = true;
  willing.valve.overlap = willing.valve.pilot_hysteresis_kpa = 0;
  auto steady = logs;
  for (Log& log : steady) std::fill(log.supply_kpa.begin(), log.supply_kpa.end(), log.supply_kpa.front());
  const SettledLoop loop = settled_loop(world.finger);
  const double mm_per_kpa = world.finger.span_mm / working_kpa;
  std::map<std::string, double> found{
      {"slow_creep", against(quick, logs)},
      {"hysteresis_shape", against(loopless, logs)},
      {"stiffening", loop.bend_mm},
      {"sensor_nonlinearity", loop.bend_mm},
      {"asymmetric_hysteresis", loop.asymmetry_mm},
      {"valve_lag", against(perfect, logs)},
      {"transport_delay", mm_per_kpa * dead_time_kpa(logs, simulate(world, {}, logs, seed))},
      {"valve_deadband", against(willing, logs)},
      {"supply_sag", against(world, steady)}};
  for (auto it = found.begin(); it != found.end();)
    it = it->second > visible_mm ? std::next(it) : found.erase(it);
  return found;
}

}  // namespace textbook
