#include "sysid/changes/healthy_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/statistics.h"
#include "sysid/evidence/f_quantile.h"
#include "sysid/limits/limits.h"

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

double prediction_bound(const std::vector<double>& errors) {
  const auto n = static_cast<double>(errors.size());
  PairSums logarithms;
  for (const double error : errors) {
    const double logarithm = std::log(std::max(error, std::numeric_limits<double>::min()));
    logarithms.add(logarithm, logarithm);
  }
  const double deviation = std::sqrt(std::max(0.0, logarithms.variance_x()) / (n * (n - 1)));
  const double quantile = std::sqrt(f_quantile(limits::probability, 1, n - 1));  // of Student's t, two-sided
  return std::exp(logarithms.x / n + quantile * deviation * std::sqrt(1 + 1 / n));
}

RunSpread::RunSpread(const std::vector<HealthyFits>& healthy, std::size_t runs, const Disagreement& more)
    : factor_(run_to_run_factor(runs)), more_(more) {
  std::vector<double> rms, losses;
  for (const HealthyFits& unit : healthy) {
    rms.push_back(unit.readings.plain_rms({}));
    losses.push_back(per_bin(unit.readings, unit.readings.white({})));
    mean_square_ += square(rms.back()) / static_cast<double>(healthy.size());
  }
  if (runs < 2 || healthy.size() < 2) return;
  const auto with_more = [&](double value) { return std::sqrt(square(value) + more.mean_square); };
  rms_bound_ = with_more(prediction_bound(rms));
  worst_rms_ = with_more(*std::max_element(rms.begin(), rms.end()));
  loss_bound_ = prediction_bound(losses) + more.loss;
  worst_loss_ = *std::max_element(losses.begin(), losses.end()) + more.loss;
}

}  // namespace softgrip::sysid
