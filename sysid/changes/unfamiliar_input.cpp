#include "sysid/changes/unfamiliar_input.h"

#include <algorithm>
#include <cmath>

#include "base/statistics.h"
#include "sysid/changes/base_prediction.h"
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

}  // namespace

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
  return judged.input_factor > limits::unfamiliar_factor;
}

}  // namespace softgrip::sysid
