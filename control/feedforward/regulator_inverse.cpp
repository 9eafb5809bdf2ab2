#include "control/feedforward/valve_inverse.h"

#include <algorithm>
#include <cmath>

#include "control/elements/lag_share.h"

namespace softgrip::control {
namespace {

constexpr double moves_kpa_per_s = 0.2;
/// Smallest difference between error and overlap from which the flow through the port is estimated [kPa]. A
/// smaller difference causes a pressure change that is too small for this estimate.
constexpr double shows_kpa = 0.01;

}  // namespace

double direction_of(double way_kpa, double tick_s) noexcept {
  return std::clamp(way_kpa / (moves_kpa_per_s * tick_s), -1.0, 1.0);
}

RegulatorInverse::RegulatorInverse(const model::RegulatedPressure<double>& regulated, double tick_s)
    : regulated_(regulated),
      tick_s_(tick_s),
      filling_share_(lag_share(tick_s, regulated.numbers().filling_s)),
      venting_share_(lag_share(tick_s, regulated.numbers().venting_s)) {}

void RegulatorInverse::take_over(const model::RegulatedPressure<double>& regulated) noexcept {
  regulated_ = regulated;
}

double RegulatorInverse::command_for(double next_kpa) const noexcept {
  const model::RegulatorNumbers<double>& n = regulated_.numbers();
  const double now_kpa = regulated_.output(), way_kpa = next_kpa - now_kpa;
  const bool fills = way_kpa >= 0;
  const double share = fills ? filling_share_ : venting_share_;
  double opened_kpa = direction_of(way_kpa, tick_s_) * n.overlap_kpa + way_kpa / share;
  const double time_constant_s = fills ? n.filling_s : n.venting_s;
  if (n.full_open_kpa > 0 && time_constant_s > 0) {
    // The opening is limited to its largest useful value. With this value, the port is fully open even at the
    // end of the tick, although the error decreases during the tick.
    const double comes_kpa = (n.full_open_kpa - n.overlap_kpa) * tick_s_ / time_constant_s;
    const double most_kpa = n.full_open_kpa + comes_kpa;
    opened_kpa = std::clamp(opened_kpa, -most_kpa, most_kpa);
  }
  // In the first half of the tick, the error also changes the integral, which opens the port further.
  const double drift = n.integral_s > 0 ? 0.5 * tick_s_ / n.integral_s : 0;
  const double error_kpa = (opened_kpa - regulated_.integral_kpa() + 0.5 * drift * way_kpa) / (1 + drift);
  return now_kpa + error_kpa;
}

double RegulatorInverse::advance(double command_kpa) noexcept {
  const double before_kpa = regulated_.output(), integral_kpa = regulated_.integral_kpa();
  regulated_.step(model::Segment<double>::straight(tick_s_, command_kpa, command_kpa),
                  [](const model::Segment<double>&) {});
  const double after_kpa = regulated_.output();
  const double opened_kpa = command_kpa - before_kpa + 0.5 * (integral_kpa + regulated_.integral_kpa());
  const double full_kpa = regulated_.numbers().full_open_kpa;
  const double beyond_kpa = std::abs(opened_kpa) - regulated_.numbers().overlap_kpa;
  if (beyond_kpa > shows_kpa && !(full_kpa > 0 && std::abs(opened_kpa) >= full_kpa)) {
    double& share = opened_kpa > 0 ? filling_share_ : venting_share_;
    share = std::clamp(std::abs(after_kpa - before_kpa) / beyond_kpa, 1e-3, 1.0);
  }
  return after_kpa;
}

}  // namespace softgrip::control
