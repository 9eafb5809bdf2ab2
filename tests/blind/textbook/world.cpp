#include "world.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "variation.h"

namespace textbook {
namespace {

constexpr double valve_step_s = 0.00025;
constexpr int finger_steps = 5;     // simulation steps of the finger per sample
constexpr double supply_kpa = 200;  // nominal supply pressure (gauge) [kPa]

// Parameters of the effects of a world. They are read from the map once per world, because the simulation
// takes millions of steps. If the world does not have an effect, the parameters of this effect are 0.
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

// Age of the finger and its largest load. Both continue from one log to the next.
struct Age {
  double time_s = 0, largest_kpa = 0;
};

// Computes the setpoint of the pressure regulator, sample by sample.
class Asked {
 public:
  Asked(const Hidden& hidden, const Log& log) : h_(hidden), log_(log) {}
  // Returns the setpoint at sample `k`. Call this function for one sample after the other. It does not use
  // commands of later samples.
  double at(std::size_t k, const std::vector<double>& command) {
    const double place = std::max(0.0, static_cast<double>(k) - h_.transport_delay_delay_s * log_.rate_hz);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, command.size() - 1);
    const double part = place - static_cast<double>(low);
    double u = (1 - part) * command[low] + part * command[high];
    if (std::abs(u - held_) > h_.valve_deadband_band_kpa) held_ = u;
    u = held_;
    if (h_.has_pressure_saturation) u = std::min(u, h_.pressure_saturation_limit_kpa);
    u *= 1 + h_.supply_sag_per_supply * (log_.supply_kpa[k] / supply_kpa - 1);
    const double tau = h_.valve_lag_time_constant_s;
    lagged_ = tau > 0 ? lagged_ + (u - lagged_) * -std::expm1(-1 / (log_.rate_hz * tau)) : u;
    return std::max(0.0, lagged_);
  }

 private:
  const Hidden& h_;
  const Log& log_;
  double held_ = 0, lagged_ = 0;
};

ValveNumbers numbers_of(const World& world, const Hidden& hidden) {
  ValveNumbers numbers = world.valve;
  numbers.leak_conductance = hidden.leak_conductance;
  numbers.tube_conductance *= 1 - hidden.blocked_line_share;
  return numbers;
}

// The pressure line from the command to the finger, including the pressure regulator.
class Line {
 public:
  Line(const World& world, const Hidden& hidden, const Log& log, const std::vector<double>& command)
      : log_(log),
        perfect_(world.perfect_valve),
        valve_(numbers_of(world, hidden)),
        asked_(hidden, log),
        now_(asked_.at(0, command)) {}
  double gauge_kpa() const { return perfect_ ? now_ : valve_.gauge_kpa(); }
  // Simulates the line from sample `k` to the next sample. After the last sample, the setpoint stays
  // constant.
  void advance(std::size_t k, const std::vector<double>& command) {
    const double next = k + 1 < command.size() ? asked_.at(k + 1, command) : now_;
    const int steps = perfect_ ? 0 : static_cast<int>(std::lround(1 / (log_.rate_hz * valve_step_s)));
    for (int i = 0; i < steps; ++i) {
      const double part = (i + 0.5) / steps;
      valve_.step((1 - part) * now_ + part * next, log_.supply_kpa[k], valve_step_s);
    }
    now_ = next;
  }

 private:
  const Log& log_;
  bool perfect_;
  Valve valve_;
  Asked asked_;
  double now_;
};

std::vector<double> pressure(const World& world, const Hidden& hidden, const Log& log) {
  Line line(world, hidden, log, log.command_kpa);
  std::vector<double> out(log.command_kpa.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = line.gauge_kpa();
    line.advance(k, log.command_kpa);
  }
  return out;
}

class Body {
 public:
  Body(const World& world, const Hidden& hidden, Age& age, const Log& log)
      : h_(hidden), age_(age), log_(log), finger_(world.finger), span_(world.finger.span_mm) {}

  // Returns the displacement at sample `k`. The pressure is assumed to change linearly between two samples.
  double sample(std::size_t k, double pressure_kpa) {
    double y = 0;
    for (int i = 1; i <= finger_steps; ++i) {
      const double part = static_cast<double>(i) / finger_steps;
      y = step(before_ + part * (pressure_kpa - before_), log_.temperature_c[k],
               1 / (log_.rate_hz * finger_steps));
    }
    before_ = pressure_kpa;
    return y;
  }

 private:
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
    return shown(loaded(log_.gain * y, dt), dt);
  }
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
    const double per_mm = h_.stiffening_per_mm;  // at a displacement of one span, the factor is 1, so
                                                 // stiffening does not change the span
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
    y += log_.offset_mm;
    if (h_.has_sensor_saturation) y = std::min(y, h_.sensor_saturation_limit_mm);
    return y;
  }

  const Hidden& h_;
  Age& age_;
  const Log& log_;
  Finger finger_;
  double span_, before_ = 0;
  double last_ = 0, friction_ = 0, slow_ = 0, crescent_ = 0, speed_ = 0, moved_ = 0, carried_ = 0, seen_ = 0;
};

// Adds an error of constant size and random sign to single readings of the sensor.
class WrongSamples {
 public:
  WrongSamples(const Hidden& hidden, std::uint64_t seed) : h_(hidden), random_(seed * 2147483647 + 11) {}
  double added_to(double y) {
    const double sign = chance_(random_) < 0.5 ? -1 : 1;
    return chance_(random_) < h_.outliers_share ? y + sign * h_.outliers_size_mm : y;
  }

 private:
  const Hidden& h_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> chance_{0, 1};
};

// Runs the controller that follows the reference of a log in closed loop. If a log has no reference, its
// commands stay unchanged.
class Follower {
 public:
  Follower(const World& world, const Log& log) : log_(log) {
    if (!log.reference_mm.empty())
      controller_.emplace(world.finger.span_mm / working_kpa, working_kpa, log.rate_hz);
  }
  // Computes the command of sample `k` + 1. `y` is the displacement at sample `k` without sensor noise.
  void decide(std::size_t k, double y, std::vector<double>& command) {
    if (!controller_ || k < log_.unrecorded || k + 1 >= command.size()) return;
    command[k + 1] = controller_->step(log_.reference_mm[k + 1], y + log_.noise_mm[k - log_.unrecorded]);
  }

 private:
  const Log& log_;
  std::optional<variation::Controller> controller_;
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
  const Hidden hidden{effects};
  Age age;
  WrongSamples wrong(hidden, seed);
  std::vector<Answer> answers;
  for (const Log& log : logs) {
    Answer answer;
    answer.command_kpa = log.command_kpa;
    Line line(world, hidden, log, answer.command_kpa);
    Body body(world, hidden, age, log);
    Follower follower(world, log);
    for (std::size_t k = 0; k < answer.command_kpa.size(); ++k) {
      answer.pressure_kpa.push_back(line.gauge_kpa());
      answer.displacement_mm.push_back(wrong.added_to(body.sample(k, answer.pressure_kpa.back())));
      follower.decide(k, answer.displacement_mm.back(), answer.command_kpa);
      line.advance(k, answer.command_kpa);
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed, const Pressures& pressures) {
  const Hidden hidden{effects};
  Age age;
  WrongSamples wrong(hidden, seed);
  std::vector<double> all;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    Body body(world, hidden, age, logs[i]);
    for (std::size_t k = 0; k < pressures[i].size(); ++k)
      all.push_back(wrong.added_to(body.sample(k, pressures[i][k])));
  }
  return all;
}

std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed) {
  return displacements(world, effects, logs, seed, simulate_pressures(world, effects, logs));
}

}  // namespace textbook
