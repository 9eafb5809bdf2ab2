#include "sysid/changes/regulator.h"

#include <algorithm>
#include <cmath>

#include "model/port_flow.h"

namespace softgrip::sysid {
namespace {

using model::atmosphere_kpa;

/// Longest simulation step [s], and largest number of steps in one sampling interval. The number of steps can
/// be limited because the implicit steps are stable. The limit applies to sampling intervals of more than
/// 0.1 s, which do not resolve the dynamics of a regulator.
constexpr double longest_step_s = 0.002;
constexpr int most_steps = 50;
/// Assumed supply pressure as a multiple of the largest command. It is used if the supply pressure is not
/// recorded.
constexpr double supply_unknown = 4;
/// Returns the flow between two absolute pressures, divided by the conductance [kPa].
double flow(double from_kpa, double to_kpa) {
  return from_kpa < to_kpa ? -model::port_flow(to_kpa, from_kpa) : model::port_flow(from_kpa, to_kpa);
}

/// Simulates one regulator. The pressures in finger, valve and supply are absolute.
class Walk {
 public:
  Walk(const Regulator& regulator, double command_kpa)
      : regulator_(regulator),
        seen_kpa_(command_kpa),
        finger_kpa_(command_kpa + atmosphere_kpa),
        valve_kpa_(finger_kpa_) {}

  void step(double command_kpa, double supply_kpa, double step_s) {
    const Regulator& r = regulator_;
    seen_kpa_ = std::clamp(seen_kpa_, command_kpa - r.play_kpa, command_kpa + r.play_kpa);
    const double valve_kpa = before_the_tube(supply_kpa, step_s);
    const double through = through_the_tube(valve_kpa, step_s);
    spool_kpa_ = spool_with(valve_kpa, step_s);
    valve_kpa_ = valve_kpa;
    const double error = seen_kpa_ + atmosphere_kpa - valve_kpa;
    const bool stopped =
        std::abs(error + integral_kpa_) > r.dead_kpa + r.full_kpa && (error + integral_kpa_) * error > 0;
    if (!stopped) integral_kpa_ += r.integral_per_s * error * step_s;
    const double lost = r.leak_per_s > 0 ? r.leak_per_s * flow(finger_kpa_, atmosphere_kpa) : 0;
    finger_kpa_ += step_s * (through - lost);
  }
  [[nodiscard]] double gauge_kpa() const { return finger_kpa_ - atmosphere_kpa; }

 private:
  /// Returns the position of the spool at the end of a step [kPa]. The position is stated as the control
  /// error that holds the spool there at equilibrium.
  [[nodiscard]] double spool_with(double valve_kpa, double step_s) const {
    const Regulator& r = regulator_;
    const double most = r.dead_kpa + r.full_kpa;
    const double wanted = std::clamp(seen_kpa_ + atmosphere_kpa - valve_kpa + integral_kpa_, -most, most);
    return spool_kpa_ + (wanted - spool_kpa_) * step_s / (step_s + r.spool_lag_s);
  }
  /// Returns the flow through the ports, stated as the pressure rate that this flow would cause in the finger
  /// [kPa/s].
  [[nodiscard]] double inflow(double spool_kpa, double valve_kpa, double supply_kpa) const {
    const Regulator& r = regulator_;
    const double open = std::min((std::abs(spool_kpa) - r.dead_kpa) / r.full_kpa, 1.0);
    if (!(open > 0)) return 0;
    return r.port_per_s * open *
           (spool_kpa > 0 ? flow(supply_kpa, valve_kpa) : -flow(valve_kpa, atmosphere_kpa));
  }
  /// Returns the flow into the finger, stated as the pressure rate in the finger [kPa/s]. During one step,
  /// the flow can at most equalise the pressures at the two ends of the tube.
  [[nodiscard]] double through_the_tube(double valve_kpa, double step_s) const {
    const double above = valve_kpa - finger_kpa_;
    if (above == 0) return 0;
    const double flows = regulator_.tube_per_s * flow(valve_kpa, finger_kpa_);
    return flows / (1 + step_s * flows / above);
  }
  /// Returns the flow through the ports, minus the flow into the tube, minus the flow that fills the chamber
  /// [kPa/s].
  [[nodiscard]] double surplus(double valve_kpa, double supply_kpa, double step_s) const {
    const Regulator& r = regulator_;
    return inflow(spool_with(valve_kpa, step_s), valve_kpa, supply_kpa) -
           through_the_tube(valve_kpa, step_s) - r.chamber_share * (valve_kpa - valve_kpa_) / step_s;
  }
  /// Returns the pressure before the tube for which surplus() is zero. surplus() decreases when this pressure
  /// increases. The secant method starts from the pressure of the previous step and nearly always converges.
  /// If it does not converge, the method of false position is used.
  [[nodiscard]] double before_the_tube(double supply_kpa, double step_s) const {
    constexpr int most_secants = 6;
    constexpr double beside_kpa = 0.01;
    double last_kpa = valve_kpa_, last = surplus(last_kpa, supply_kpa, step_s);
    if (last == 0) return last_kpa;
    double next_kpa = last_kpa + std::copysign(beside_kpa, last);
    for (int i = 0; i < most_secants; ++i) {
      const double next = surplus(next_kpa, supply_kpa, step_s);
      const double slope = (next - last) / (next_kpa - last_kpa);
      if (!(slope < 0)) break;
      last_kpa = next_kpa;
      last = next;
      next_kpa = std::clamp(next_kpa - next / slope, atmosphere_kpa, supply_kpa);
      if (std::abs(next_kpa - last_kpa) < near_kpa) return next_kpa;
    }
    return by_false_position(supply_kpa, step_s);
  }
  /// Finds the zero of surplus() by the method of false position (Illinois algorithm).
  [[nodiscard]] double by_false_position(double supply_kpa, double step_s) const {
    constexpr int most = 40;
    double low = atmosphere_kpa, high = supply_kpa;
    double at_low = surplus(low, supply_kpa, step_s), at_high = surplus(high, supply_kpa, step_s);
    if (!(at_low > 0)) return low;
    if (!(at_high < 0)) return high;
    bool was_low = false, was_high = false;
    double between = valve_kpa_;
    for (int i = 0; i < most && high - low > near_kpa; ++i) {
      const double value = surplus(between, supply_kpa, step_s);
      if (value == 0) break;
      if (value > 0) {
        low = between;
        at_low = value;
        if (was_low) at_high *= 0.5;
      } else {
        high = between;
        at_high = value;
        if (was_high) at_low *= 0.5;
      }
      was_low = value > 0;
      was_high = !was_low;
      between = low + at_low / (at_low - at_high) * (high - low);
    }
    return between;
  }

  /// Accuracy of the pressure before the tube [kPa].
  static constexpr double near_kpa = 1e-4;

  Regulator regulator_;
  double seen_kpa_, finger_kpa_, valve_kpa_;
  double integral_kpa_ = 0, spool_kpa_ = 0;
};

}  // namespace

double leaking_kpa_per_s(double gauge_kpa) {
  return flow(gauge_kpa + atmosphere_kpa, atmosphere_kpa);
}

std::vector<double> regulated(const Regulator& regulator, const Record& record,
                              const std::vector<double>& command_kpa) {
  Walk walk(regulator, command_kpa.front());
  std::vector<double> out(command_kpa.size(), walk.gauge_kpa());
  const double unknown_kpa = supply_unknown * record.largest_kpa + atmosphere_kpa;
  for (std::size_t i = 1; i < out.size(); ++i) {
    const double supply_kpa = record.supply_kpa.empty() ? unknown_kpa : record.supply_kpa[i] + atmosphere_kpa;
    const double wanted = std::ceil(record.duration_s[i] / longest_step_s - 1e-6);
    const int steps = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_steps)));
    const double step_s = record.duration_s[i] / steps;
    for (int s = 0; s < steps; ++s) {
      const double part = record.held ? 0 : (s + 0.5) / steps;
      walk.step((1 - part) * command_kpa[i - 1] + part * command_kpa[i], supply_kpa, step_s);
    }
    out[i] = walk.gauge_kpa();
  }
  return out;
}

Record behind(const Regulator& regulator, const Record& record) {
  Record driven = record;
  driven.drive_kpa = regulated(regulator, record, record.drive_kpa);
  driven.held = false;
  return driven;
}

}  // namespace softgrip::sysid
