#pragma once
// A simulated finger for the tests of change detection. Its equations differ from the equations of the models
// in the project. The finger has an elastic part, a part with play and a part that creeps. Its valve has no
// dynamics by default.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid::test {

struct Finger {
  double gain = 0.2;     ///< gain of the finger, mm/kPa
  double stop_mm = 1e9;  ///< largest displacement [mm]
  double zero_mm = 0;
  double lost_kpa_per_s = 0;  ///< rate at which pressure is lost at a constant command of 60 kPa [kPa/s];
                              ///< the rate is proportional to the command, and the loss is at most 1.5 kPa
  double delay_s = 0;
  double valve_lag_s = 0;
  double per_c = 0;  ///< relative change of the gain per degree above 15 degC
  bool with_temperature = false;
  double bend_per_mm = 0;  ///< coefficient of stiffening with the displacement [1/mm]; a displacement of 12
                           ///< mm stays unchanged
  double crescent_mm = 0;  ///< largest width of a hysteresis loop [mm]; loading follows a parabola and
                           ///< unloading follows a line
  double weight_kpa = 0;   ///< pressure that balances a weight on the finger [kPa]
  double drift_mm = 0;     ///< amplitude of a drift of the zero offset [mm] with a period of about 15 s
};

/// Returns a command that repeats a ramp to a random pressure, a hold, and a ramp to 0. `seed` determines the
/// pressures and the durations.
inline std::vector<double> command_kpa(unsigned seed, std::size_t samples, double rate_hz) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> height(20, 58), time(1.5, 4);
  std::vector<double> out(static_cast<std::size_t>(rate_hz), 0.0);
  const auto line = [&](double to, double s) {
    const double from = out.back();
    const auto n = static_cast<int>(s * rate_hz);
    for (int i = 1; i <= n; ++i) out.push_back(from + (to - from) * i / n);
  };
  while (out.size() < samples) {
    line(height(random), time(random));
    line(out.back(), time(random));
    line(0, time(random));
  }
  out.resize(samples);
  return out;
}

/// Returns the output pressure of a first-order lag at the end of one sample. The input pressure is linear
/// between two samples, like the command of a record.
/// @param lagged_kpa, from_kpa  output and input pressure of the lag at the previous sample.
/// @param to_kpa  input pressure of the lag at this sample.
inline double lagged_kpa(double lagged_kpa, double from_kpa, double to_kpa, double step_s, double lag_s) {
  if (lag_s <= 0) return to_kpa;
  const double behind_kpa = lag_s * (to_kpa - from_kpa) / step_s;
  return to_kpa - behind_kpa + (lagged_kpa - from_kpa + behind_kpa) * std::exp(-step_s / lag_s);
}

/// Returns the log of the finger, sampled at 50 Hz. @param samples  number of samples.
inline Log log_of(const Finger& finger, unsigned seed, bool with_pressure = false,
                  std::size_t samples = 2000) {
  constexpr double rate_hz = 50;
  std::mt19937 random(seed + 100);
  std::normal_distribution<double> noise(0, 1);
  Log log;
  log.name = "log" + std::to_string(seed);
  log.pressure_command_kpa = command_kpa(seed, samples, rate_hz);
  double play = 0, creep = 0, lost = 0, behind = 0, wanted = 0, between = 0;
  const double phase = 2 * seed;
  const auto late = static_cast<std::size_t>(finger.delay_s * rate_hz);
  for (std::size_t i = 0; i < log.pressure_command_kpa.size(); ++i) {
    const double u = log.pressure_command_kpa[i >= late ? i - late : 0];
    const double before = log.pressure_command_kpa[i > late ? i - late - 1 : 0];
    lost = u == before ? std::min(lost + finger.lost_kpa_per_s / rate_hz * u / 60, 1.5) : 0.8 * lost;
    const double p = behind = lagged_kpa(behind, wanted, u - lost, 1 / rate_hz, finger.valve_lag_s);
    wanted = u - lost;
    const double q = p - finger.weight_kpa;
    play = std::clamp(play, q - 3, q + 3);
    creep += (q - creep) / (rate_hz * 4);
    const double t = static_cast<double>(i) / rate_hz;
    const double temperature_c = 24 + 3 * std::sin(t / 8 + phase);
    double y = finger.gain * (1 + finger.per_c * (temperature_c - 15)) * (0.6 * q + 0.3 * play + 0.1 * creep);
    const double part = std::max(p, 0.0) / 58;
    between = std::clamp(between, part * part, part);
    y += 4 * finger.crescent_mm * (between - 0.5 * (part + part * part));
    y *= (1 + 12 * finger.bend_per_mm) / (1 + finger.bend_per_mm * std::max(y, 0.0));
    const double drift = finger.drift_mm * std::sin(t * 0.4 + phase + std::sin(t * 0.17 + 3 * phase));
    log.time_s.push_back(t);
    log.displacement_mm.push_back(std::min(y, finger.stop_mm) + finger.zero_mm + drift +
                                  0.03 * noise(random));
    if (finger.with_temperature) log.temperature_c.push_back(temperature_c);
    if (with_pressure) log.pressure_kpa.push_back(p + 0.03 * noise(random));
  }
  return log;
}

inline std::vector<Log> logs_of(const Finger& finger, unsigned first_seed, bool with_pressure = false,
                                std::size_t samples = 2000) {
  return {log_of(finger, first_seed, with_pressure, samples),
          log_of(finger, first_seed + 1, with_pressure, samples)};
}

}  // namespace softgrip::sysid::test
