#include "sysid/diagnosis/search/coherence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/numbers.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/model.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

constexpr FitEffort alone{.most_iterations = 40, .tolerance = 1e-6};

/// Returns the share of the variance of the readings that the fit explains. The share is negative if the fit
/// has a larger error than a constant prediction by the mean of the readings.
double explained_share(const std::vector<Record>& records, const StructureFit& fit) {
  double sum = 0, squares = 0, count = 0;
  for (const Record& record : records) {
    for (const double y : record.reading_mm) {
      if (!std::isfinite(y)) continue;
      sum += y;
      squares += y * y;
      count += 1;
    }
  }
  if (count == 0) return 0;
  const double variance = squares / count - (sum / count) * (sum / count);
  return variance > 0 ? 1 - fit.mean_square_mm2 / variance : 0;
}

/// Returns the gain between the predicted and the measured motion of a log: the slope of a linear regression
/// of the readings on the prediction.
double relative_gain(const Record& record, const std::vector<double>& prediction_mm) {
  double count = 0, p = 0, y = 0, pp = 0, py = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!std::isfinite(record.reading_mm[i])) continue;
    count += 1;
    p += prediction_mm[i];
    y += record.reading_mm[i];
    pp += prediction_mm[i] * prediction_mm[i];
    py += prediction_mm[i] * record.reading_mm[i];
  }
  const double spread = pp - p * p / count;
  const double gain = spread > 0 ? (py - p * y / count) / spread : 1;
  return gain > 0.1 ? gain : 1;
}

/// Returns the model after the motion of its actuator is multiplied by `gain`.
model::Model amplified(model::Model model, double gain) {
  if (const auto at = model::position_of<model::BoucWen>(model)) {
    model.blocks[*at].values[0] *= gain;
    model.blocks[*at].values[1] *= gain;
  }
  if (const auto at = model::position_of<model::KelvinVoigt>(model)) {
    for (double& stiffness_or_damping : model.blocks[*at].values) stiffness_or_damping /= gain;
  }
  return model;
}

/// Fits the structure to each log separately, starting at the common fit to all logs. Returns the RMSE of
/// these fits over all logs.
double rmse_apart_mm(const std::vector<Record>& records, const StructureFit& fit) {
  double squares = 0, count = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    std::vector<Record> one{records[k]};
    // The sensor zero is fitted for each log, because logs from different rigs have different zeros.
    one.front().offset_free = true;
    const double gain = relative_gain(records[k], predict(fit.point.model, records[k], fit.point.starts[k]));
    const FitPoint from{fit.point.model, {fit.point.starts[k]}};
    const FitPoint scaled{amplified(fit.point.model, gain), {fit.point.starts[k]}};
    const double own = std::min(fit_structure(one, fit.causes, from, alone).mean_square_mm2,
                                fit_structure(one, fit.causes, scaled, alone).mean_square_mm2);
    squares += own * static_cast<double>(records[k].readings);
    count += static_cast<double>(records[k].readings);
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace

std::optional<std::string> inconsistent_among(const std::vector<Record>& records,
                                              const StructureFit& recalibrated, double together_mm2) {
  if (records.size() < 2) return std::nullopt;
  const double apart_mm = rmse_apart_mm(records, recalibrated);
  if (!(apart_mm * apart_mm < limits::equal_error_share * together_mm2)) return std::nullopt;
  const std::string unit(model::name_of(records.front().output_unit));
  return "after recalibration on each log separately, the error of the model is " + significant(apart_mm, 2) +
         " " + unit + ", but after recalibration on all logs together, the error is " +
         significant(std::sqrt(together_mm2), 2) + " " + unit +
         ". Check that all logs come from one rig and that the rig was not changed between the logs";
}

std::optional<std::string> why_not_about(const std::vector<Record>& records,
                                         const StructureFit& recalibrated) {
  const double share = explained_share(records, recalibrated);
  if (share >= limits::least_explained_share) return std::nullopt;
  if (auto inconsistent = inconsistent_among(records, recalibrated, recalibrated.mean_square_mm2))
    return inconsistent;
  return "the readings do not follow the command: the fitted model explains only " +
         fixed(100 * std::max(0.0, share), 0) +
         " % of the variance of the readings. Check the sensor, the sign of its readings, the channel and "
         "the units";
}

}  // namespace softgrip::sysid
