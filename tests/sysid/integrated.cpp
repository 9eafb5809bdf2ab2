#include "tests/sysid/integrated.h"

#include <array>
#include <cmath>
#include <random>

#include "model/chain.h"

namespace softgrip::sysid {
namespace {

using State = std::array<double, 3>;  // state of the finger: h, displacements of the first and the second
                                      // creep branch

State slope(const IntegratedFinger& f, const State& x, double p, double rate) {
  const double h = x[0];
  return {f.beta * rate - f.gamma * rate * std::abs(h) - f.eta * std::abs(rate) * h, (p - f.k1 * x[1]) / f.c1,
          (p - f.k2 * x[2]) / f.c2};
}

State moved(const State& x, const State& k, double dt) {
  return {x[0] + dt * k[0], x[1] + dt * k[1], x[2] + dt * k[2]};
}

/// Integrates the state over one step of `dt`. The pressure begins at `p` and changes at the constant rate
/// `rate`.
State stepped(const IntegratedFinger& f, const State& x, double p, double rate, double dt) {
  const State k1 = slope(f, x, p, rate);
  const State k2 = slope(f, moved(x, k1, dt / 2), p + rate * dt / 2, rate);
  const State k3 = slope(f, moved(x, k2, dt / 2), p + rate * dt / 2, rate);
  const State k4 = slope(f, moved(x, k3, dt), p + rate * dt, rate);
  State sum;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) / 6;
  return moved(x, sum, dt);
}

}  // namespace

Log integrated(const IntegratedFinger& finger, model::SignalName signal, double rate_hz, double noise_mm,
               std::uint64_t seed) {
  Log log;
  log.name = std::string(model::name_of(signal));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, noise_mm);
  State x{};
  const auto samples = static_cast<std::size_t>(std::lround(model::duration_s(signal) * rate_hz)) + 1;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    const double p = model::value_kpa(signal, t);
    if (i > 0) {
      const double last = log.pressure_command_kpa.back();
      const double rate = (p - last) * rate_hz;
      constexpr int fine = 50;
      const double dt = 1 / (rate_hz * fine);
      for (int j = 0; j < fine; ++j) x = stepped(finger, x, last + rate * dt * j, rate, dt);
    }
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(p);
    log.displacement_mm.push_back(finger.alpha * p - x[0] + p / finger.k0 + x[1] + x[2] + noise(random));
  }
  return log;
}

std::vector<double> pressures_behind(const model::Model& model, const Log& log) {
  model::Chain<double> chain(model);
  std::vector<double> pressures{chain.pressure_kpa()};
  for (std::size_t i = 1; i < log.size(); ++i) {
    chain.step(log.time_s[i] - log.time_s[i - 1], log.pressure_command_kpa[i]);
    pressures.push_back(chain.pressure_kpa());
  }
  return pressures;
}

}  // namespace softgrip::sysid
