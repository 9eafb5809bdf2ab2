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

// Simulates a finger without creep. Returns two properties of its second loop from 0 to working pressure: the
// curvature and the asymmetry.
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

// Returns the RMS [kPa] of the difference between the pressure of the valve and the command after a dead time
// `delay_s` and a first-order lag `tau_s`.
double lag_miss_kpa(const std::vector<Log>& logs, const std::vector<Answer>& answers, double tau_s,
                    double delay_s) {
  double sum = 0, count = 0;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const std::vector<double>& command = logs[l].command_kpa;
    const double share = -std::expm1(-1 / (logs[l].rate_hz * tau_s));
    double lagged = 0;
    for (std::size_t k = 0; k < command.size(); ++k, ++count) {
      const double miss = answers[l].pressure_kpa[k] - lagged;
      sum += miss * miss;
      // Between two samples, the input of the lag is constant: the command at the middle of the interval.
      const double place = std::max(0.0, static_cast<double>(k) + 0.5 - delay_s * logs[l].rate_hz);
      const auto low = std::min(static_cast<std::size_t>(place), command.size() - 2);
      const double part = place - static_cast<double>(low);
      lagged += ((1 - part) * command[low] + part * command[low + 1] - lagged) * share;
    }
  }
  return std::sqrt(sum / count);
}

double dead_time_kpa(const std::vector<Log>& logs, const std::vector<Answer>& answers) {
  double lag = 1e9, both = 1e9;
  for (double delay_s = 0; delay_s < 0.05; delay_s += 0.003) {
    for (double tau_s = 0.002; tau_s < 0.3; tau_s *= 1.2) {
      const double miss = lag_miss_kpa(logs, answers, tau_s, delay_s);
      both = std::min(both, miss);
      if (delay_s == 0) lag = std::min(lag, miss);
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
