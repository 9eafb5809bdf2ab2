#include "sysid/changes/unfamiliar_input.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.h"
#include "sysid/changes/base_prediction.h"
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

/// Returns the largest disagreement that is expected about another healthy run, from the mean disagreement
/// about the healthy units.
Disagreement expected_disagreement(const Base& base, const HealthyModel& other) {
  const LaterReadings all(base, base.records, minus(base.left, other.left));
  Disagreement expected;
  double units = 0;
  for (std::size_t unit = 0; unit < base.units.count(); ++unit) {
    const LaterReadings own = all.only(base.units, unit);
    if (own.records().empty()) continue;
    const auto [mean_square, loss] = disagreement(own);
    expected.mean_square += mean_square;
    expected.loss += loss;
    units += 1;
  }
  const double factor = run_to_run_factor(base.units.runs()) / std::max(1.0, units);
  expected.mean_square *= factor;
  expected.loss *= factor;
  return expected;
}

/// Returns the distance of the command from the pressure that the baseline model predicts, at each sample.
std::vector<double> distance_kpa(const Base& base, const Record& record) {
  std::vector<double> distance = predict_base(base, record, {});
  for (std::size_t i = 0; i < distance.size(); ++i) distance[i] = record.drive_kpa[i] - distance[i];
  return distance;
}

}  // namespace

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

Disagreement added_disagreement(const Base& base, const std::vector<Record>& later) {
  const std::vector<std::vector<double>> own = residuals_of(base, later);
  Disagreement most;
  for (const HealthyModel& other : base.alternatives) {
    const Disagreement healthy = expected_disagreement(base, other);
    const std::vector<std::vector<double>> differing =
        minus(own, residuals_of(with_model(base, other), later));
    const Disagreement now = disagreement(readings_of(base, later, differing));
    if (!std::isfinite(now.mean_square) || !std::isfinite(now.loss)) continue;  // the alternative diverges
    most.mean_square = std::max(most.mean_square, now.mean_square - healthy.mean_square);
    most.loss = std::max(most.loss, now.loss - healthy.loss);
  }
  return most;
}

bool has_unfamiliar_input(const JudgedChange& judged) {
  return judged.input_factor > limits::unfamiliar_factor ||
         judged.unevaluated_share > limits::equal_error_share;
}

}  // namespace softgrip::sysid
