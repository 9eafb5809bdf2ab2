#include "world.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace textbook {
namespace {

constexpr double valve_step_s = 0.00025;
constexpr int finger_steps = 5;     // per sample
constexpr double supply_kpa = 200;  // nominal, gauge

class Hidden {
 public:
  explicit Hidden(const Effects& effects) : effects_(effects) {}
  bool has(const char* id) const { return effects_.count(id) > 0; }
  double at(const char* id, const char* name) const {
    const auto found = effects_.find(id);
    return found == effects_.end() ? 0 : found->second.at(name);
  }

 private:
  const Effects& effects_;
};

// What runs on from log to log.
struct Age {
  double time_s = 0, largest_kpa = 0;
};

std::vector<double> asked(const Hidden& hidden, const Log& log) {
  std::vector<double> out(log.command_kpa.size());
  const double delay = hidden.at("transport_delay", "delay_s") * log.rate_hz;
  const double tau = hidden.at("valve_lag", "time_constant_s");
  const double band = hidden.at("valve_deadband", "band_kpa");
  double held = 0, lagged = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double place = std::max(0.0, static_cast<double>(k) - delay);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, out.size() - 1);
    const double part = place - static_cast<double>(low);
    double u = (1 - part) * log.command_kpa[low] + part * log.command_kpa[high];
    if (std::abs(u - held) > band) held = u;
    u = held;
    if (hidden.has("pressure_saturation")) u = std::min(u, hidden.at("pressure_saturation", "limit_kpa"));
    u *= 1 + hidden.at("supply_sag", "per_supply") * (log.supply_kpa[k] / supply_kpa - 1);
    lagged = tau > 0 ? lagged + (u - lagged) * -std::expm1(-1 / (log.rate_hz * tau)) : u;
    out[k] = std::max(0.0, lagged);
  }
  return out;
}

std::vector<double> pressure(const World& world, const Hidden& hidden, const Log& log) {
  const auto command = asked(hidden, log);
  if (world.perfect_valve) return command;
  ValveNumbers numbers = world.valve;
  numbers.leak_conductance = hidden.at("leak", "conductance");
  numbers.tube_conductance *= 1 - hidden.at("blocked_line", "share");
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
    double q = std::max(0.0, p - h_.at("actuator_threshold", "threshold_kpa"));
    if (h_.has("rate_dependent_hysteresis")) {
      friction_ +=
          (std::tanh(rate / 5) * std::sqrt(std::abs(rate) / 40) - friction_) * -std::expm1(-dt / 0.05);
      q = std::max(0.0, q - h_.at("rate_dependent_hysteresis", "kpa") * friction_);
    }
    double y = finger_.step(q, dt);
    if (h_.has("slow_creep")) {
      slow_ += (p - slow_) * -std::expm1(-dt / h_.at("slow_creep", "time_constant_s"));
      y += h_.at("slow_creep", "gain_mm_per_kpa") * slow_;
    }
    y = bent(y, p) * (1 + h_.at("thermal_gain", "per_c") * (temperature_c - 22)) *
        (1 + h_.at("ageing", "per_s") * age_.time_s);
    return shown(loaded(y, dt), dt);
  }

 private:
  double bent(double y, double p) {
    const double x = p / working_kpa;
    if (h_.has("asymmetric_hysteresis")) {
      crescent_ = std::clamp(crescent_, std::min(x, x * x * x), std::max(x, x * x * x));
      y += h_.at("asymmetric_hysteresis", "share") * span_ * (crescent_ - 0.5 * (x + x * x * x));
    }
    if (h_.has("stress_softening")) {
      age_.largest_kpa = std::max(age_.largest_kpa, p);
      const double below = 1 - std::exp(-(age_.largest_kpa - p) / h_.at("stress_softening", "range_kpa"));
      y *= 1 + h_.at("stress_softening", "share") * below * age_.largest_kpa / working_kpa;
    }
    const double per_mm = h_.at("stiffening", "per_mm");  // the span is kept
    return y * (1 + per_mm * span_) / (1 + per_mm * std::max(0.0, y));
  }
  double loaded(double y, double dt) {
    if (h_.has("contact")) {
      const double stop = h_.at("contact", "position_mm");
      if (y > stop) y = stop + (y - stop) / (1 + h_.at("contact", "stiffness_ratio"));
    }
    if (h_.has("inertia")) {
      const double w = 2 * 3.14159265358979 * h_.at("inertia", "frequency_hz");
      constexpr int parts = 8;
      for (int i = 0; i < parts; ++i) {
        speed_ += (w * w * (y - moved_) - 2 * h_.at("inertia", "damping") * w * speed_) * dt / parts;
        moved_ += speed_ * dt / parts;
      }
      y = moved_;
    }
    if (h_.has("backlash")) {
      const double half = h_.at("backlash", "play_mm") / 2;
      carried_ = std::clamp(carried_, y - half, y + half);
      y = carried_;
    }
    return y;
  }
  double shown(double y, double dt) {
    if (h_.has("sensor_lag")) {
      seen_ += (y - seen_) * -std::expm1(-dt / h_.at("sensor_lag", "time_constant_s"));
      y = seen_;
    }
    y += h_.at("sensor_nonlinearity", "share") * y * (1 - y / span_);
    const double t = age_.time_s;
    if (h_.has("sensor_drift"))
      y += h_.at("sensor_drift", "mm") * (t / 200 + 0.4 * std::sin(t / 37 + h_.at("sensor_drift", "phase")));
    if (h_.has("periodic_disturbance"))
      y += h_.at("periodic_disturbance", "mm") *
           std::sin(2 * 3.14159265358979 * h_.at("periodic_disturbance", "frequency_hz") * t);
    if (h_.has("sensor_saturation")) y = std::min(y, h_.at("sensor_saturation", "limit_mm"));
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

std::vector<Answer> simulate(const World& world, const Effects& effects, const std::vector<Log>& logs,
                             std::uint64_t seed) {
  const Hidden hidden(effects);
  Age age;
  std::vector<Answer> answers;
  std::mt19937_64 random(seed * 2147483647 + 11);
  std::uniform_real_distribution<double> chance(0, 1);
  for (const Log& log : logs) {
    Answer answer{pressure(world, hidden, log), {}};
    Body body(world, hidden, age);
    double before = 0;
    for (std::size_t k = 0; k < answer.pressure_kpa.size(); ++k) {
      double y = 0;
      for (int i = 1; i <= finger_steps; ++i) {
        const double part = static_cast<double>(i) / finger_steps;
        y = body.step(before + part * (answer.pressure_kpa[k] - before), log.temperature_c[k],
                      1 / (log.rate_hz * finger_steps));
      }
      before = answer.pressure_kpa[k];
      const double sign = chance(random) < 0.5 ? -1 : 1;
      if (chance(random) < hidden.at("outliers", "share")) y += sign * hidden.at("outliers", "size_mm");
      answer.displacement_mm.push_back(y);
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

std::vector<double> displacements(const World& world, const Effects& effects, const std::vector<Log>& logs,
                                  std::uint64_t seed) {
  std::vector<double> all;
  for (const Answer& a : simulate(world, effects, logs, seed))
    all.insert(all.end(), a.displacement_mm.begin(), a.displacement_mm.end());
  return all;
}

}  // namespace textbook
