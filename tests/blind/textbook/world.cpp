#include "world.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace textbook {
namespace {

constexpr double valve_step_s = 0.00025;
constexpr int finger_steps = 5;     // per sample
constexpr double supply_kpa = 200;  // nominal, gauge

// The numbers of the effects, each looked up once: a world is simulated in millions of steps. 0 where there
// is none.
struct Hidden {
  const Effects& effects;

  bool has_pressure_saturation = effects.count("pressure_saturation") > 0;
  bool has_rate_dependent_hysteresis = effects.count("rate_dependent_hysteresis") > 0;
  bool has_slow_creep = effects.count("slow_creep") > 0;
  bool has_asymmetric_hysteresis = effects.count("asymmetric_hysteresis") > 0;
  bool has_stress_softening = effects.count("stress_softening") > 0;
  bool has_contact = effects.count("contact") > 0;
  bool has_inertia = effects.count("inertia") > 0;
  bool has_backlash = effects.count("backlash") > 0;
  bool has_sensor_lag = effects.count("sensor_lag") > 0;
  bool has_sensor_drift = effects.count("sensor_drift") > 0;
  bool has_periodic_disturbance = effects.count("periodic_disturbance") > 0;
  bool has_sensor_saturation = effects.count("sensor_saturation") > 0;

  double transport_delay_delay_s = number("transport_delay", "delay_s");
  double valve_lag_time_constant_s = number("valve_lag", "time_constant_s");
  double valve_deadband_band_kpa = number("valve_deadband", "band_kpa");
  double pressure_saturation_limit_kpa = number("pressure_saturation", "limit_kpa");
  double supply_sag_per_supply = number("supply_sag", "per_supply");
  double leak_conductance = number("leak", "conductance");
  double blocked_line_share = number("blocked_line", "share");
  double actuator_threshold_threshold_kpa = number("actuator_threshold", "threshold_kpa");
  double rate_dependent_hysteresis_kpa = number("rate_dependent_hysteresis", "kpa");
  double slow_creep_time_constant_s = number("slow_creep", "time_constant_s");
  double slow_creep_gain_mm_per_kpa = number("slow_creep", "gain_mm_per_kpa");
  double thermal_gain_per_c = number("thermal_gain", "per_c");
  double ageing_per_s = number("ageing", "per_s");
  double asymmetric_hysteresis_share = number("asymmetric_hysteresis", "share");
  double stress_softening_range_kpa = number("stress_softening", "range_kpa");
  double stress_softening_share = number("stress_softening", "share");
  double stiffening_per_mm = number("stiffening", "per_mm");
  double contact_position_mm = number("contact", "position_mm");
  double contact_stiffness_ratio = number("contact", "stiffness_ratio");
  double inertia_frequency_hz = number("inertia", "frequency_hz");
  double inertia_damping = number("inertia", "damping");
  double backlash_play_mm = number("backlash", "play_mm");
  double sensor_lag_time_constant_s = number("sensor_lag", "time_constant_s");
  double sensor_nonlinearity_share = number("sensor_nonlinearity", "share");
  double sensor_drift_mm = number("sensor_drift", "mm");
  double sensor_drift_phase = number("sensor_drift", "phase");
  double periodic_disturbance_mm = number("periodic_disturbance", "mm");
  double periodic_disturbance_frequency_hz = number("periodic_disturbance", "frequency_hz");
  double sensor_saturation_limit_mm = number("sensor_saturation", "limit_mm");
  double outliers_share = number("outliers", "share");
  double outliers_size_mm = number("outliers", "size_mm");

  double number(const char* id, const char* name) const {
    const auto found = effects.find(id);
    return found == effects.end() ? 0 : found->second.at(name);
  }
};

// What runs on from log to log.
struct Age {
  double time_s = 0, largest_kpa = 0;
};

std::vector<double> asked(const Hidden& hidden, const Log& log) {
  std::vector<double> out(log.command_kpa.size());
  const double delay = hidden.transport_delay_delay_s * log.rate_hz;
  const double tau = hidden.valve_lag_time_constant_s;
  const double band = hidden.valve_deadband_band_kpa;
  double held = 0, lagged = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double place = std::max(0.0, static_cast<double>(k) - delay);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, out.size() - 1);
    const double part = place - static_cast<double>(low);
    double u = (1 - part) * log.command_kpa[low] + part * log.command_kpa[high];
    if (std::abs(u - held) > band) held = u;
    u = held;
    if (hidden.has_pressure_saturation) u = std::min(u, hidden.pressure_saturation_limit_kpa);
    u *= 1 + hidden.supply_sag_per_supply * (log.supply_kpa[k] / supply_kpa - 1);
    lagged = tau > 0 ? lagged + (u - lagged) * -std::expm1(-1 / (log.rate_hz * tau)) : u;
    out[k] = std::max(0.0, lagged);
  }
  return out;
}

std::vector<double> pressure(const World& world, const Hidden& hidden, const Log& log) {
  const auto command = asked(hidden, log);
  if (world.perfect_valve) return command;
  ValveNumbers numbers = world.valve;
  numbers.leak_conductance = hidden.leak_conductance;
  numbers.tube_conductance *= 1 - hidden.blocked_line_share;
  Valve valve(numbers);
  const int steps = static_cast<int>(std::lround(1 / (log.rate_hz * valve_step_s)));
  std::vector<double> out(command.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = valve.gauge_kpa();
    const double next = command[std::min(k + 1, out.size() - 1)];
    for (int i = 0; i < steps; ++i) {
      const double part = (i + 0.5) / steps;
      valve.step((1 - part) * command[k] + part * next, log.supply_kpa[k], valve_step_s);
    }
  }
  return out;
}

class Body {
 public:
  Body(const World& world, const Hidden& hidden, Age& age)
      : h_(hidden), age_(age), finger_(world.finger), span_(world.finger.span_mm) {}

  double step(double p, double temperature_c, double dt) {
    const double rate = (p - last_) / dt;
    last_ = p;
    age_.time_s += dt;
    double q = std::max(0.0, p - h_.actuator_threshold_threshold_kpa);
    if (h_.has_rate_dependent_hysteresis) {
      friction_ +=
          (std::tanh(rate / 5) * std::sqrt(std::abs(rate) / 40) - friction_) * -std::expm1(-dt / 0.05);
      q = std::max(0.0, q - h_.rate_dependent_hysteresis_kpa * friction_);
    }
    double y = finger_.step(q, dt);
    if (h_.has_slow_creep) {
      slow_ += (p - slow_) * -std::expm1(-dt / h_.slow_creep_time_constant_s);
      y += h_.slow_creep_gain_mm_per_kpa * slow_;
    }
    y = bent(y, p) * (1 + h_.thermal_gain_per_c * (temperature_c - 22)) * (1 + h_.ageing_per_s * age_.time_s);
    return shown(loaded(y, dt), dt);
  }

 private:
  double bent(double y, double p) {
    const double x = p / working_kpa;
    if (h_.has_asymmetric_hysteresis) {
      crescent_ = std::clamp(crescent_, std::min(x, x * x * x), std::max(x, x * x * x));
      y += h_.asymmetric_hysteresis_share * span_ * (crescent_ - 0.5 * (x + x * x * x));
    }
    if (h_.has_stress_softening) {
      age_.largest_kpa = std::max(age_.largest_kpa, p);
      const double below = 1 - std::exp(-(age_.largest_kpa - p) / h_.stress_softening_range_kpa);
      y *= 1 + h_.stress_softening_share * below * age_.largest_kpa / working_kpa;
    }
    const double per_mm = h_.stiffening_per_mm;  // the span is kept
    return y * (1 + per_mm * span_) / (1 + per_mm * std::max(0.0, y));
  }
  double loaded(double y, double dt) {
    if (h_.has_contact) {
      const double stop = h_.contact_position_mm;
      if (y > stop) y = stop + (y - stop) / (1 + h_.contact_stiffness_ratio);
    }
    if (h_.has_inertia) {
      const double w = 2 * 3.14159265358979 * h_.inertia_frequency_hz;
      constexpr int parts = 8;
      for (int i = 0; i < parts; ++i) {
        speed_ += (w * w * (y - moved_) - 2 * h_.inertia_damping * w * speed_) * dt / parts;
        moved_ += speed_ * dt / parts;
      }
      y = moved_;
    }
    if (h_.has_backlash) {
      const double half = h_.backlash_play_mm / 2;
      carried_ = std::clamp(carried_, y - half, y + half);
      y = carried_;
    }
    return y;
  }
  double shown(double y, double dt) {
    if (h_.has_sensor_lag) {
      seen_ += (y - seen_) * -std::expm1(-dt / h_.sensor_lag_time_constant_s);
      y = seen_;
    }
    y += h_.sensor_nonlinearity_share * y * (1 - y / span_);
    const double t = age_.time_s;
    if (h_.has_sensor_drift)
      y += h_.sensor_drift_mm * (t / 200 + 0.4 * std::sin(t / 37 + h_.sensor_drift_phase));
    if (h_.has_periodic_disturbance)
      y += h_.periodic_disturbance_mm *
           std::sin(2 * 3.14159265358979 * h_.periodic_disturbance_frequency_hz * t);
    if (h_.has_sensor_saturation) y = std::min(y, h_.sensor_saturation_limit_mm);
    return y;
  }

  const Hidden& h_;
  Age& age_;
  Finger finger_;
  double span_;
  double last_ = 0, friction_ = 0, slow_ = 0, crescent_ = 0, speed_ = 0, moved_ = 0, carried_ = 0, seen_ = 0;
};

}  // namespace

World draw_world(const std::string& make, std::uint64_t seed) {
  std::mt19937_64 random(seed * 6700417 + 5);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  World world;
  world.finger = draw_finger(make, seed);
  ValveNumbers& v = world.valve;
  v.port_conductance *= between(0.7, 1.4);
  v.tube_conductance *= between(0.8, 1.3);
  v.critical_ratio = between(0.2, 0.45);
  v.finger_volume_dm3 *= between(0.6, 1.5);
  v.overlap = between(0.02, 0.06);
  v.pilot_hysteresis_kpa = between(0.05, 0.3);
  return world;
}

Pressures simulate_pressures(const World& world, const Effects& effects, const std::vector<Log>& logs) {
  const Hidden hidden{effects};
  Pressures pressures;
  for (const Log& log : logs) pressures.push_back(pressure(world, hidden, log));
  return pressures;
}

bool acts_on_pressure(const Effects& effects) {
  static const std::vector<std::string> acting{
      "blocked_line",   "leak",     "pressure_saturation", "supply_sag", "transport_delay",
      "valve_deadband", "valve_lag"};
  return std::any_of(acting.begin(), acting.end(),
                     [&](const std::string& id) { return effects.count(id) > 0; });
}

std::vector<Answer> simulate(const World& world, const Effects& effects, const std::vector<Log>& logs,
                             std::uint64_t seed) {
  Pressures pressures = simulate_pressures(world, effects, logs);
  const std::vector<double> moved = displacements(world, effects, logs, seed, pressures);
  std::vector<Answer> answers;
  auto from = moved.begin();
  for (std::vector<double>& pressure_kpa : pressures) {
    const auto to = from + static_cast<std::ptrdiff_t>(pressure_kpa.size());
    answers.push_back({std::move(pressure_kpa), {from, to}});
    from = to;
  }
  return answers;
}

std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed, const Pressures& pressures) {
  const Hidden hidden{effects};
  Age age;
  std::vector<double> all;
  std::mt19937_64 random(seed * 2147483647 + 11);
  std::uniform_real_distribution<double> chance(0, 1);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const Log& log = logs[i];
    Body body(world, hidden, age);
    double before = 0;
    for (std::size_t k = 0; k < pressures[i].size(); ++k) {
      double y = 0;
      for (int step = 1; step <= finger_steps; ++step) {
        const double part = static_cast<double>(step) / finger_steps;
        y = body.step(before + part * (pressures[i][k] - before), log.temperature_c[k],
                      1 / (log.rate_hz * finger_steps));
      }
      before = pressures[i][k];
      const double sign = chance(random) < 0.5 ? -1 : 1;
      if (chance(random) < hidden.outliers_share) y += sign * hidden.outliers_size_mm;
      all.push_back(y);
    }
  }
  return all;
}

std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed) {
  return displacements(world, effects, logs, seed, simulate_pressures(world, effects, logs));
}

}  // namespace textbook
