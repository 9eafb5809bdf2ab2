#include "sysid/changes/healthy_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/random.h"
#include "base/statistics.h"
#include "sysid/changes/base_prediction.h"
#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// @param differing  readings whose residual is the difference between two predictions.
Disagreement disagreement(const LaterReadings& differing) {
  return {square(differing.plain_rms({})), per_bin(differing, differing.white({}))};
}

Base with_model(Base base, const HealthyModel& model) {
  static_cast<HealthyModel&>(base) = model;
  return base;
}

Disagreement scaled(const Disagreement& one, double factor) {
  return {factor * one.mean_square, factor * one.loss};
}

/// Returns the mean over the healthy units.
/// @param differing  values of all healthy records, averaged over bins.
Disagreement mean_of_units(const Base& base, const Binned& differing) {
  const LaterReadings all(base, base.records, differing);
  Disagreement mean;
  double units = 0;
  for (std::size_t unit = 0; unit < base.units.count(); ++unit) {
    const LaterReadings own = all.only(base.units, unit);
    if (own.records().empty()) continue;
    const auto [mean_square, loss] = disagreement(own);
    mean.mean_square += mean_square;
    mean.loss += loss;
    units += 1;
  }
  return scaled(mean, 1 / std::max(1.0, units));
}

/// Returns the largest disagreement that is expected about another healthy run, from the mean disagreement
/// about the healthy units.
Disagreement expected_disagreement(const Base& base, const HealthyModel& other) {
  return scaled(mean_of_units(base, minus(base.left, other.left)), run_to_run_factor(base.units.runs()));
}

/// Returns white noise with the standard deviation of the noise of the readings, averaged over bins.
Binned noise_of(const Base& base) {
  Binned noise;
  for (std::size_t r = 0; r < base.records.size(); ++r) {
    std::vector<double> series(base.records[r].size());
    for (std::size_t i = 0; i < series.size(); ++i) series[i] = base.noise_mm * normal_at(r, i);
    noise.push_back(with_bins(binned(base.records[r], series, base.bin_s), base.left[r].size()));
  }
  return noise;
}

/// Returns the distance of the command from the pressure that the baseline model predicts, at each sample.
std::vector<double> distance_kpa(const Base& base, const Record& record) {
  std::vector<double> distance = predict_base(base, record, {});
  for (std::size_t i = 0; i < distance.size(); ++i) distance[i] = record.drive_kpa[i] - distance[i];
  return distance;
}

}  // namespace

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
  static_assert(limits::probability == 0.95);
  return std::exp(logarithms.x / n + t_quantile(n - 1) * deviation * std::sqrt(1 + 1 / n));
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

double remove_unfamiliar_commands(const Base& base, const std::vector<Record>& later,
                                  std::vector<std::vector<double>>& left_kpa) {
  constexpr double most = limits::comparable_ratio;
  double lowest_kpa = 0, highest_kpa = 0, removed = 0, all = 0;
  for (const Record& healthy : base.records) {
    for (const double kpa : distance_kpa(base, healthy)) {
      lowest_kpa = std::min(lowest_kpa, kpa);
      highest_kpa = std::max(highest_kpa, kpa);
    }
  }
  for (std::size_t r = 0; r < later.size(); ++r) {
    // The healthy records are thinned, which reduces the distance at a step, so the later one is thinned too.
    const Record thinned = thinned_for(base, later[r]);
    const std::vector<double> distance = distance_kpa(base, thinned);
    double until_s = -std::numeric_limits<double>::infinity();
    std::size_t next = 0;
    for (std::size_t i = 0; i < later[r].size(); ++i) {
      for (; next < thinned.size() && thinned.time_s[next] <= later[r].time_s[i]; ++next) {
        if (distance[next] < most * lowest_kpa || distance[next] > most * highest_kpa)
          until_s = thinned.time_s[next] + valve_lags_s.back();
      }
      all += 1;
      if (later[r].time_s[i] > until_s) continue;
      left_kpa[r][i] = std::numeric_limits<double>::quiet_NaN();
      removed += 1;
    }
  }
  return all > 0 ? removed / all : 0;
}

Disagreement added_by_motion(const Base& base, const std::vector<Record>& later) {
  std::vector<std::vector<double>> motion;
  motion.reserve(later.size());
  for (const Record& record : later) motion.push_back(predict_base(base, record, {}));
  const Disagreement now = disagreement(readings_of(base, later, motion));
  const Disagreement healthy = mean_of_units(base, healthy_readings(base).plain());
  const Disagreement error = mean_of_units(base, base.left), noise = mean_of_units(base, noise_of(base));
  const auto added = [](double error_of_model, double motion_now, double healthy_motion) {
    if (!(error_of_model > 0 && healthy_motion > 0 && motion_now > healthy_motion)) return 0.0;
    return error_of_model * (motion_now / healthy_motion - 1);
  };
  return {added(error.mean_square - noise.mean_square, now.mean_square, healthy.mean_square),
          added(error.loss - noise.loss, now.loss, healthy.loss)};
}

Disagreement added_disagreement(const Base& base, std::vector<Record> later) {
  // An estimated initial state depends on the readings. A drift would then look like an unlike input.
  for (Record& record : later) record.start = Start::rest;
  const std::vector<std::vector<double>> own = residuals_of(base, later);
  Disagreement most;
  for (const HealthyModel& other : base.alternatives) {
    const Disagreement healthy = expected_disagreement(base, other);
    const std::vector<std::vector<double>> differing =
        minus(own, residuals_of(with_model(base, other), later));
    const Disagreement now = disagreement(readings_of(base, later, differing));
    const bool diverges = !std::isfinite(now.loss) || !(now.mean_square < square(base.span_mm));
    if (diverges) continue;
    most.mean_square = std::max(most.mean_square, now.mean_square - healthy.mean_square);
    most.loss = std::max(most.loss, now.loss - healthy.loss);
  }
  // The permitted error is run_to_run_factor() of the healthy runs times the result. The healthy runs do not
  // show the error for the later input. The disagreement is as uncertain as the error of a single run.
  most = scaled(most, run_to_run_factor(1) / run_to_run_factor(base.units.runs()));
  const Disagreement motion = added_by_motion(base, later);
  return {std::max(most.mean_square, motion.mean_square), std::max(most.loss, motion.loss)};
}

bool has_unfamiliar_input(const JudgedChange& judged) {
  return judged.input_factor > limits::unfamiliar_factor ||
         judged.unevaluated_share > limits::equal_error_share;
}

}  // namespace softgrip::sysid
