#include "world.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <random>

#include "variation.h"

namespace blind {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double largest_pressure_step_kpa = 0.25;
constexpr double largest_command_kpa = 60;

double number(const Effects& effects, const std::string& id, const std::string& name, double otherwise) {
  const auto effect = effects.find(id);
  return effect == effects.end() ? otherwise : effect->second.at(name);
}
double sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

// All parameters that the integration needs. They are read from the map once per simulation, not in every
// step.
struct Numbers {
  explicit Numbers(const Effects& e)
      : delay_s(number(e, "transport_delay", "delay_s", 0)),
        lag_s(number(e, "valve_lag", "time_constant_s", 0)),
        band_kpa(number(e, "valve_deadband", "band_kpa", 0)),
        pressure_limit_kpa(number(e, "pressure_saturation", "limit_kpa", 1e9)),
        sag(number(e, "supply_sag", "sensitivity", 0)),
        threshold_kpa(number(e, "actuator_threshold", "threshold_kpa", 0)),
        stiffening(number(e, "stiffening", "per_mm", 0)),
        asymmetry(number(e, "asymmetric_hysteresis", "delta_per_kpa", 0)),
        rate(number(e, "rate_dependent_hysteresis", "growth", 0)),
        softening(number(e, "stress_softening", "per_kpa", 0)),
        creep_gain(number(e, "slow_creep", "gain_mm_per_kpa", 0)),
        creep_tau_s(number(e, "slow_creep", "time_constant_s", 1)),
        thermal(number(e, "thermal_gain", "per_c", 0)),
        ageing(number(e, "ageing", "per_s", 0)),
        contact_mm(number(e, "contact", "position_mm", 1e9)),
        contact_ratio(number(e, "contact", "stiffness_ratio", 0)),
        mode_hz(number(e, "inertia", "frequency_hz", 0)),
        mode_damping(number(e, "inertia", "damping", 1)),
        play_mm(number(e, "backlash", "play_mm", 0)),
        sensor_lag_s(number(e, "sensor_lag", "time_constant_s", 0)),
        drift(number(e, "sensor_drift", "amplitude_mm", 0)),
        drift_phase(number(e, "sensor_drift", "phase", 0)),
        drift_period_s(number(e, "sensor_drift", "period_s", 1)),
        bend(number(e, "sensor_nonlinearity", "bend_mm", 0)),
        bend_span(number(e, "sensor_nonlinearity", "span_mm", 1)),
        sensor_limit_mm(number(e, "sensor_saturation", "limit_mm", 1e9)),
        disturbance_mm(number(e, "periodic_disturbance", "amplitude_mm", 0)),
        disturbance_hz(number(e, "periodic_disturbance", "frequency_hz", 1)),
        disturbance_phase(number(e, "periodic_disturbance", "phase", 0)),
        outlier_mm(number(e, "outliers", "size_mm", 0)),
        outlier_share(number(e, "outliers", "share", 0)),
        fill_s(number(e, "outside_fill_vent_lag", "fill_s", 0)),
        vent_s(number(e, "outside_fill_vent_lag", "vent_s", 0)),
        bumps_mm(number(e, "outside_bumps", "size_mm", 0)),
        modulation(number(e, "outside_gain_modulation", "depth", 0)),
        modulation_hz(number(e, "outside_gain_modulation", "frequency_hz", 1)),
        stops_mm(number(e, "outside_stop_operators", "gain_mm_per_kpa", 0)),
        crosstalk_mm(number(e, "outside_crosstalk", "amplitude_mm", 0)),
        recovery(number(e, "outside_rest_recovery", "depth", 0)) {}

  double delay_s, lag_s, band_kpa, pressure_limit_kpa, sag, threshold_kpa, stiffening, asymmetry, rate,
      softening, creep_gain, creep_tau_s, thermal, ageing, contact_mm, contact_ratio, mode_hz, mode_damping,
      play_mm, sensor_lag_s, drift, drift_phase, drift_period_s, bend, bend_span, sensor_limit_mm,
      disturbance_mm, disturbance_hz, disturbance_phase, outlier_mm, outlier_share, fill_s, vent_s, bumps_mm,
      modulation, modulation_hz, stops_mm, crosstalk_mm, recovery;
};

// State of the finger that continues from one log to the next.
struct Memory {
  double largest_kpa = 0;
  double campaign_s = 0;
};

// Returns the state x after one step of the classical Runge-Kutta method. The state relaxes towards a target
// that changes linearly during the step.
double relax(double x, double from, double to, double tau, double dt) {
  const auto f = [&](double share, double value) { return (from + share * (to - from) - value) / tau; };
  const double k1 = f(0, x), k2 = f(0.5, x + 0.5 * dt * k1), k3 = f(0.5, x + 0.5 * dt * k2),
               k4 = f(1, x + dt * k3);
  return x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

class Rig {
 public:
  Rig(const Base& base, const Numbers& n, Memory& memory, std::uint64_t seed, double gain = 1,
      double offset_mm = 0)
      : base_(base), n_(n), memory_(memory), gain_(gain), offset_mm_(offset_mm), random_(seed) {}

  // Simulates one integration step. The command changes linearly from `from` to `to`.
  void step(double from, double to, double temperature, double supply, double dt) {
    const double wanted = valve(from, to, supply, dt);
    const double share_before = std::max(0.0, pressure_ - n_.threshold_kpa);
    const double share_after = std::max(0.0, wanted - n_.threshold_kpa);
    actuator(share_before, share_after, dt);
    pressure_ = wanted;
    memory_.largest_kpa = std::max(memory_.largest_kpa, share_after);
    memory_.campaign_s += dt;
    free_mm_ = displacement(share_after, temperature, dt);
    load(dt);
    seen_mm_ =
        n_.sensor_lag_s > 0 ? relax(seen_mm_, before_sensor_, moved_mm_, n_.sensor_lag_s, dt) : moved_mm_;
    before_sensor_ = moved_mm_;
  }

  double pressure() const { return pressure_; }

  // Simulates one position of a gauge check. The target of the sensor is removed from the finger and held at
  // this position until all transients of the sensor have decayed.
  void hold_target(double position_mm) { seen_mm_ = position_mm; }
  void wait(double duration_s) { memory_.campaign_s += duration_s; }

  double reading() {
    double y = seen_mm_;
    const double t = memory_.campaign_s;
    y += n_.bend * 4 * (y / n_.bend_span) * (1 - y / n_.bend_span);
    y += n_.drift * (std::sin(2 * pi * t / n_.drift_period_s + n_.drift_phase) - std::sin(n_.drift_phase));
    y += n_.disturbance_mm * std::sin(2 * pi * n_.disturbance_hz * t + n_.disturbance_phase);
    y += n_.crosstalk_mm * std::sin(2 * pi * 0.11 * t + 3 * std::sin(2 * pi * 0.017 * t));
    if (n_.bumps_mm > 0) y += bumps();
    if (uniform_(random_) < n_.outlier_share) y += n_.outlier_mm * (uniform_(random_) < 0.5 ? -1 : 1);
    return std::min(y + offset_mm_, n_.sensor_limit_mm);
  }

 private:
  double valve(double from, double to, double supply, double dt) {
    if (n_.delay_s > 0) {
      line_.push_back(to);
      const double back = n_.delay_s / dt;
      const auto whole = static_cast<std::size_t>(back);
      const double part = back - static_cast<double>(whole);
      const auto at = [&](std::size_t k) { return k < line_.size() ? line_[line_.size() - 1 - k] : 0.0; };
      const double now = at(whole) * (1 - part) + at(whole + 1) * part;
      from = delayed_;
      to = now;
      delayed_ = now;
      if (line_.size() > whole + 3) line_.pop_front();
    }
    if (n_.band_kpa > 0) {
      from = held_;
      if (std::abs(to - held_) > n_.band_kpa) held_ = to;
      to = held_;
    }
    const double factor = 1 + n_.sag * (supply - 500) / 500;
    from *= factor;
    to *= factor;
    if (n_.lag_s > 0) to = lagged_ = relax(lagged_, from, to, n_.lag_s, dt);
    if (n_.fill_s > 0) to = lagged_ = relax(lagged_, from, to, to > lagged_ ? n_.fill_s : n_.vent_s, dt);
    return std::min(to, n_.pressure_limit_kpa);
  }

  double hysteresis_slope(double h, double direction) const {
    const double shape = base_.gamma + base_.eta * sign(direction * h) + n_.asymmetry * sign(direction);
    return base_.beta - std::abs(h) * shape;
  }

  void actuator(double before, double after, double dt) {
    const double dp = after - before;
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(dp) / largest_pressure_step_kpa)));
    for (int i = 0; i < parts; ++i) {
      const double d = dp / parts;
      const double k1 = hysteresis_slope(h_, dp), k2 = hysteresis_slope(h_ + 0.5 * d * k1, dp),
                   k3 = hysteresis_slope(h_ + 0.5 * d * k2, dp), k4 = hysteresis_slope(h_ + d * k3, dp);
      h_ += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    fast_ = relax(fast_, base_.fast_gain * before, base_.fast_gain * after, base_.fast_tau, dt);
    slow_ = relax(slow_, base_.slow_gain * before, base_.slow_gain * after, base_.slow_tau, dt);
    if (n_.creep_gain != 0)
      creep_ = relax(creep_, n_.creep_gain * before, n_.creep_gain * after, n_.creep_tau_s, dt);
    rate_ = relax(rate_, std::abs(dp) / dt, std::abs(dp) / dt, 0.05, dt);
    if (n_.stops_mm != 0)
      for (std::size_t i = 0; i < stops_.size(); ++i)
        stops_[i] =
            std::clamp(stops_[i] + dp, -4.0 * static_cast<double>(i + 1), 4.0 * static_cast<double>(i + 1));
    rest_s_ = after < 0.5 ? rest_s_ + dt : std::max(0.0, rest_s_ - 4 * dt);
  }

  double displacement(double p, double temperature, double) {
    double y = (base_.alpha + base_.instantaneous) * p - h_ * (1 + n_.rate * rate_ / (rate_ + 20)) + fast_ +
               slow_ + creep_;
    for (std::size_t i = 0; i < stops_.size(); ++i) y += n_.stops_mm * stops_[i] / static_cast<double>(i + 1);
    y *= 1 + n_.softening * memory_.largest_kpa;
    y *= 1 + n_.thermal * (temperature - 20);
    y *= 1 + n_.ageing * memory_.campaign_s;
    y *= 1 + n_.modulation * std::sin(2 * pi * n_.modulation_hz * memory_.campaign_s);
    y *= 1 - n_.recovery * std::exp(-rest_s_ / 6);
    return gain_ * y / (1 + n_.stiffening * std::abs(y));
  }

  void load(double dt) {
    double y = free_mm_;
    if (y > n_.contact_mm) y = n_.contact_mm + (y - n_.contact_mm) / (1 + n_.contact_ratio);
    if (n_.mode_hz > 0) {
      const double w = 2 * pi * n_.mode_hz;
      const auto acceleration = [&](double x, double v, double target) {
        return w * w * (target - x) - 2 * n_.mode_damping * w * v;
      };
      const double middle = 0.5 * (mode_target_ + y);
      const double k1x = mode_v_, k1v = acceleration(mode_x_, mode_v_, mode_target_);
      const double k2x = mode_v_ + 0.5 * dt * k1v,
                   k2v = acceleration(mode_x_ + 0.5 * dt * k1x, mode_v_ + 0.5 * dt * k1v, middle);
      const double k3x = mode_v_ + 0.5 * dt * k2v,
                   k3v = acceleration(mode_x_ + 0.5 * dt * k2x, mode_v_ + 0.5 * dt * k2v, middle);
      const double k4x = mode_v_ + dt * k3v, k4v = acceleration(mode_x_ + dt * k3x, mode_v_ + dt * k3v, y);
      mode_x_ += dt / 6 * (k1x + 2 * k2x + 2 * k3x + k4x);
      mode_v_ += dt / 6 * (k1v + 2 * k2v + 2 * k3v + k4v);
      mode_target_ = y;
      y = mode_x_;
    }
    if (n_.play_mm > 0) {
      played_ = std::clamp(played_, y - n_.play_mm / 2, y + n_.play_mm / 2);
      y = played_;
    }
    moved_mm_ = y;
  }

  // Simulates a person who touches the finger at random times. Each touch changes the reading by a random
  // amount, which then decays.
  double bumps() {
    if (memory_.campaign_s >= next_bump_s_) {
      next_bump_s_ = memory_.campaign_s + 4 + 10 * uniform_(random_);
      bump_ += n_.bumps_mm * (2 * uniform_(random_) - 1);
    }
    bump_ *= 0.995;
    return bump_;
  }

  const Base& base_;
  const Numbers& n_;
  Memory& memory_;
  double gain_, offset_mm_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::deque<double> line_;
  std::vector<double> stops_ = std::vector<double>(6, 0.0);
  double delayed_ = 0, held_ = 0, lagged_ = 0, pressure_ = 0, h_ = 0, fast_ = 0, slow_ = 0, creep_ = 0,
         rate_ = 0, rest_s_ = 0, free_mm_ = 0, moved_mm_ = 0, before_sensor_ = 0, seen_mm_ = 0, mode_x_ = 0,
         mode_v_ = 0, mode_target_ = 0, played_ = 0, bump_ = 0, next_bump_s_ = 3;
};

// Runs the controller that follows the reference of a log in closed loop. If a log has no reference, its
// commands stay unchanged.
class Follower {
 public:
  Follower(const Base& base, const LogInput& log) : log_(log) {
    if (!log.reference_mm.empty())
      controller_.emplace(span_mm(base, largest_command_kpa) / largest_command_kpa, largest_command_kpa,
                          log.rate_hz);
  }
  // Computes the command of sample `k` + 1. `y` is the displacement at sample `k` without sensor noise.
  void decide(std::size_t k, double y, std::vector<double>& command) {
    if (!controller_ || k < log_.unrecorded || k + 1 >= command.size()) return;
    const double seen = quantised(y + log_.noise_mm[k - log_.unrecorded], Sensor{}.step_mm);
    command[k + 1] = controller_->step(log_.reference_mm[k + 1], seen);
  }

 private:
  const LogInput& log_;
  std::optional<variation::Controller> controller_;
};

}  // namespace

double span_mm(const Base& base, double pressure_kpa) {
  constexpr std::size_t half = 500;
  LogInput log;
  for (std::size_t k = 0; k <= 2 * half; ++k)
    log.command_kpa.push_back(pressure_kpa * static_cast<double>(std::min(k, 2 * half - k)) / half);
  log.temperature_c.assign(log.command_kpa.size(), 20);
  log.supply_kpa.assign(log.command_kpa.size(), 500);
  const std::vector<LogOutput> out = simulate(base, {}, {log}, 0, 0.0025);
  return *std::max_element(out.front().displacement_mm.begin(), out.front().displacement_mm.end());
}

std::vector<LogOutput> simulate(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                                std::uint64_t seed, double step_s) {
  const Numbers numbers(effects);
  Memory memory;
  std::vector<LogOutput> outputs;
  for (const LogInput& log : logs) {
    Rig rig(base, numbers, memory, seed + outputs.size(), log.gain, log.offset_mm);
    Follower follower(base, log);
    LogOutput out;
    out.command_kpa = log.command_kpa;
    const double period = 1 / log.rate_hz;
    const int parts = static_cast<int>(std::lround(period / step_s));
    for (std::size_t k = 0; k < log.command_kpa.size(); ++k) {
      const double before = k == 0 ? 0.0 : out.command_kpa[k - 1];
      const double change = out.command_kpa[k] - before;
      for (int i = 0; k > 0 && i < parts; ++i)
        rig.step(before + change * i / parts, before + change * (i + 1) / parts, log.temperature_c[k],
                 log.supply_kpa[k], period / parts);
      out.pressure_kpa.push_back(rig.pressure());
      out.displacement_mm.push_back(rig.reading());
      follower.decide(k, out.displacement_mm.back(), out.command_kpa);
    }
    outputs.push_back(std::move(out));
  }
  return outputs;
}

std::vector<std::vector<double>> held_at(const Effects& effects, const std::vector<double>& positions_mm,
                                         double start_s, std::uint64_t seed, const GaugeWork& work) {
  const Numbers numbers(effects);
  const Base base;
  Memory memory;
  memory.campaign_s = start_s;
  Rig rig(base, numbers, memory, seed + 7919);
  std::mt19937_64 random(seed * 31 + 5);
  std::normal_distribution<double> placing(0, work.placing_mm);
  std::vector<std::vector<double>> series;
  for (const double position : positions_mm) {
    rig.hold_target(position + placing(random));
    rig.wait(work.every_s - static_cast<double>(work.samples) / work.rate_hz);
    std::vector<double>& samples = series.emplace_back();
    for (std::size_t i = 0; i < work.samples; ++i) {
      rig.wait(1 / work.rate_hz);
      samples.push_back(rig.reading());
    }
  }
  return series;
}

std::vector<double> noise(std::size_t samples, double rms, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, rms);
  std::vector<double> out(samples);
  for (double& value : out) value = normal(random);
  return out;
}

double quantised(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

std::vector<double> measured(const std::vector<double>& clean, double rms, double step, std::uint64_t seed) {
  std::vector<double> out = noise(clean.size(), rms, seed);
  for (std::size_t k = 0; k < clean.size(); ++k) out[k] = quantised(clean[k] + out[k], step);
  return out;
}

}  // namespace blind
