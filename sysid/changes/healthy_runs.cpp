#include "sysid/changes/healthy_runs.h"

#include <algorithm>
#include <utility>

#include "base/statistics.h"

namespace softgrip::sysid {

double per_bin(const LaterReadings& readings, const Eigen::VectorXd& white) {
  return white.squaredNorm() / static_cast<double>(std::max<std::size_t>(1, readings.rows().rows().size()));
}

std::vector<HealthyFits> healthy_fits(const Base& base, bool pressure_is_judged, unsigned threads) {
  const LaterReadings all = healthy_readings(base);
  const std::vector<Effect> effects = effects_for(base, base.records, {}, pressure_is_judged);
  std::vector<HealthyFits> units;
  for (std::size_t unit = 0; unit < base.units.count(); ++unit) {
    LaterReadings readings = all.only(base.units, unit);
    if (readings.records().empty()) continue;
    std::vector<ScoredEffect> ranked = ranked_effects(readings, effects, {}, {}, threads);
    units.push_back({std::move(readings), std::move(ranked)});
  }
  return units;
}

Tolerance tolerance_of(const std::vector<HealthyFits>& healthy, std::size_t runs, double more) {
  std::vector<NullGains> gains;
  for (const HealthyFits& unit : healthy) {
    gains.emplace_back();
    for (const ScoredEffect& each : unit.ranked) gains.back()[each.fit.fitted.effect.id] = each.gain;
  }
  return {gains, runs, more};
}

RunSpread::RunSpread(const std::vector<HealthyFits>& healthy, std::size_t runs, const Disagreement& more)
    : factor_(run_to_run_factor(runs)), more_(more), are_runs_(runs > 1) {
  for (const HealthyFits& unit : healthy) {
    const double rms = unit.readings.plain_rms({});
    mean_square_ += square(rms) / static_cast<double>(healthy.size());
    worst_rms_ = std::max(worst_rms_, rms);
    worst_loss_ = std::max(worst_loss_, per_bin(unit.readings, unit.readings.white({})));
  }
  worst_rms_ = std::sqrt(square(worst_rms_) + more.mean_square);
  worst_loss_ += more.loss;
}

}  // namespace softgrip::sysid
