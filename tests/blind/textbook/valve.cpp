#include "valve.h"

#include <algorithm>
#include <cmath>

namespace textbook {

double flow_dm3_s(double conductance, double b, double from_kpa, double to_kpa) noexcept {
  if (from_kpa < to_kpa) return -flow_dm3_s(conductance, b, to_kpa, from_kpa);
  const double ratio = to_kpa / from_kpa;
  if (ratio <= b) return conductance * from_kpa;
  constexpr double linear_above = 0.995;
  const auto subsonic = [b](double r) { return std::sqrt(1 - (r - b) * (r - b) / ((1 - b) * (1 - b))); };
  const double share =
      ratio < linear_above ? subsonic(ratio) : subsonic(linear_above) * (1 - ratio) / (1 - linear_above);
  return conductance * from_kpa * share;
}

void Valve::set(double valve_kpa, double finger_kpa, bool shut) noexcept {
  valve_kpa_ = valve_kpa;
  finger_kpa_ = finger_kpa;
  shut_ = shut;
}

void Valve::step(double command_kpa, double supply_kpa, double step_s) noexcept {
  const ValveNumbers& n = numbers_;
  pilot_kpa_ =
      std::clamp(pilot_kpa_, command_kpa - n.pilot_hysteresis_kpa, command_kpa + n.pilot_hysteresis_kpa);
  const double error = pilot_kpa_ - (valve_kpa_ - atmosphere_kpa);
  const double wanted = n.proportional_per_kpa * error + integral_;
  const bool stopped = std::abs(wanted) > 1 && wanted * error > 0;
  if (!stopped) integral_ += n.integral_per_kpa_s * error * step_s;
  spool_ += (std::clamp(wanted, -1.0, 1.0) - spool_) * step_s / n.spool_lag_s;
  const double opening = shut_ ? 0 : std::max(0.0, std::abs(spool_) - n.overlap) / (1 - n.overlap);
  const double port = n.port_conductance * opening;
  const double inflow = spool_ > 0
                            ? flow_dm3_s(port, n.critical_ratio, supply_kpa + atmosphere_kpa, valve_kpa_)
                            : -flow_dm3_s(port, n.critical_ratio, valve_kpa_, atmosphere_kpa);
  const double through = flow_dm3_s(n.tube_conductance, n.critical_ratio, valve_kpa_, finger_kpa_);
  const double lost = flow_dm3_s(n.leak_conductance, n.critical_ratio, finger_kpa_, atmosphere_kpa);
  valve_kpa_ += reference_kpa * (inflow - through) / n.valve_volume_dm3 * step_s;
  finger_kpa_ += reference_kpa * (through - lost) / n.finger_volume_dm3 * step_s;
}

}  // namespace textbook
