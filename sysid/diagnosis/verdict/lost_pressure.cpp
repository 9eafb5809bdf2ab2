#include "sysid/diagnosis/verdict/lost_pressure.h"

#include <algorithm>
#include <cmath>

#include "model/line_loss.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

double mean_of(const BlockLosses& losses) {
  const double root = rmse_mm(losses);
  return root * root;
}

double highest_kpa(const std::vector<Log>& logs) {
  double highest = 0;
  for (const Log& log : logs) {
    for (const double p : log.pressure_kpa) {
      if (std::isfinite(p)) highest = std::max(highest, p);
    }
  }
  return highest;
}

}  // namespace

std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs, const MeasuredValve& valve,
                                               ValveParts parts, const ValveStage& scaled) {
  if (!(scaled.gauge_gain < 1 - scales_agree_within)) return std::nullopt;
  constexpr double tolerance = 1e-6;
  LostPressure lost;
  const ValveStage without = valve.fit(parts, {scaled}, tolerance, PressureSensorFit::zero);
  lost.without_kpa2 = valve.held_out_losses(parts, without, PressureSensorFit::zero);
  const BlockLosses by_scale = valve.held_out_losses(parts, scaled);
  lost.parts = parts.set(index_of(ValvePart::leak));
  ValveStage start = scaled;
  start.leak_share = 1 / scaled.gauge_gain - 1;
  lost.stage = valve.fit(lost.parts, {start}, tolerance, PressureSensorFit::zero);
  lost.losses_kpa2 = valve.held_out_losses(lost.parts, lost.stage, PressureSensorFit::zero);
  const double before = mean_of(lost.without_kpa2), taken = before - mean_of(lost.losses_kpa2);
  if (taken < limits::majority_share * before ||
      taken < (1 - limits::form_error_share) * (before - mean_of(by_scale)))
    return std::nullopt;
  lost.highest_kpa = highest_kpa(logs);
  lost.missing_kpa =
      model::LineLoss<double>{lost.stage.leak_share}.before(lost.highest_kpa) - lost.highest_kpa;
  return lost;
}

}  // namespace softgrip::sysid
