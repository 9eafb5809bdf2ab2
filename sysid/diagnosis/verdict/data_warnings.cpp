#include "sysid/diagnosis/verdict/data_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "base/statistics.h"
#include "base/text.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/valve_stiction.h"
#include "model/model.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/causes/sensor_drift.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/residual/closed_loop.h"
#include "sysid/diagnosis/verdict/loop_phase.h"
#include "sysid/evidence/signature.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/excitation.h"
#include "sysid/logs/plausibility_warnings.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

constexpr FitEffort alone{.most_iterations = 40, .tolerance = 1e-6};

/// Returns the share of the variance of the readings that the fit explains. The share is negative if the fit
/// has a larger error than a constant prediction by the mean of the readings.
double explained_share(const std::vector<Record>& records, const StructureFit& fit) {
  PairSums sums;
  for (const Record& record : records) {
    for (const double y : record.reading_mm) sums.add(y, y);
  }
  if (sums.count == 0) return 0;
  const double variance = sums.xx / sums.count - square(sums.x / sums.count);
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

/// Adds a warning for each log column that is missing or constant although the test of a cause requires it.
void warn_of_columns(const Scales& scales, std::vector<std::string>& warnings) {
  for (const Column column : {Column::temperature_c, Column::supply_kpa}) {
    std::string ids;
    for (const Cause& cause : all_causes()) {
      if (cause.needs == column) ids += (ids.empty() ? "" : " and ") + std::string(cause.id);
    }
    if (!scales.has(column) && !ids.empty()) {
      warnings.push_back("the logs contain no " + std::string(name_of(column)) + " column that varies, so " +
                         ids + " cannot be tested");
    }
  }
}

void reject_drift(Diagnosis& d) {
  const auto is_drift = [](const NamedCause& named) { return named.cause.id == causes::SensorDrift::id; };
  const auto first = std::stable_partition(d.causes.begin(), d.causes.end(), std::not_fn(is_drift));
  if (first == d.causes.end()) return;
  std::move(first, d.causes.end(), std::back_inserter(d.partial));
  d.causes.erase(first, d.causes.end());
  d.verdict = d.causes.empty() ? Verdict::unexplained : Verdict::partly_explained;
  d.warnings.emplace_back(
      "The origin of a slow change is unknown. No log contains a rest without pressure, so a drift of the "
      "sensor cannot be separated from a change of the finger");
}

/// Returns a valve cause that only the test of the loops has found.
/// @param bands_kpa  dead band in each log [kPa]; the parameter of the cause is the median.
NamedCause sticking_valve(std::vector<double> bands_kpa) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  NamedCause named;
  named.cause = *find_cause(causes::ValveDeadband::id);
  named.block_type = model::block_type<model::ValveStiction>();
  named.parameters = {{"band_kpa", "kPa", median_of(std::span(bands_kpa)), {}, false}};
  named.gain_percent = named.gain_mm2 = {unknown, unknown, unknown, unknown};
  named.inclusion = unknown;
  named.only_in_loop = true;
  return named;
}

/// Names the valve instead of the causes of the search. If the extended model contains the valve, the result
/// of the search for the valve is kept.
void name_sticking_valve(Diagnosis& d, std::vector<double> bands_kpa) {
  NamedCause valve = sticking_valve(bands_kpa);
  std::move(d.causes.begin(), d.causes.end(), std::back_inserter(d.partial));
  const auto searched = std::ranges::find(d.partial, valve.cause, &NamedCause::cause);
  if (searched != d.partial.end()) {
    if (position_of(d.extended_model, valve.cause)) valve = std::move(*searched);
    d.partial.erase(searched);
  }
  d.causes = {std::move(valve)};
  d.verdict = Verdict::partly_explained;
  d.loop_bands_kpa = std::move(bands_kpa);
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

void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings) {
  if (const double ratio = beta_over_gain(model); ratio > 1)
    warnings.push_back("the recalibrated model is unphysical: " + wrong_way_sentence(ratio));
}

void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings) {
  for (std::string& implausible : plausibility_warnings_among(logs))
    warnings.push_back(std::move(implausible));
  warn_of_columns(scales, warnings);
  const bool measured =
      std::any_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
  if (!measured) {
    warnings.emplace_back(
        "the logs contain the commanded pressure but no measured pressure, so effects of the valve and "
        "effects of the actuator can be separated only if these effects are nonlinear");
  }
  for (const Excitation missing : missing_excitation(logs)) warnings.push_back(without(missing));
}

void warn_of_scale(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm,
                   std::vector<std::string>& warnings) {
  for (std::size_t k = 0; k < records.size(); ++k) {
    std::vector<double> predicted_mm = records[k].reading_mm;
    for (std::size_t i = 0; i < predicted_mm.size(); ++i) predicted_mm[i] -= residual_mm[k][i];
    if (std::string implausible =
            scale_warning(records[k].name, predicted_mm, records[k].reading_mm, records[k].output_unit);
        !implausible.empty())
      warnings.push_back(std::move(implausible));
  }
}

void correct_by_logs(Diagnosis& d, const std::vector<Log>& logs,
                     const std::function<std::vector<std::vector<double>>()>& responses) {
  if (!contains_rest(logs)) {
    d.not_tested.emplace(causes::SensorDrift::id, recording_for(Appears::at_rest));
    reject_drift(d);
  }
  const auto is_closed = [](const Log& log) {
    return is_closed_loop(log.pressure_command_kpa, log.displacement_mm);
  };
  if (!std::all_of(logs.begin(), logs.end(), is_closed)) return;
  d.warnings.emplace_back(
      "The command depends on the readings (closed loop), so the command contains the noise of the readings. "
      "A simulation with this command is therefore uncertain");
  const std::vector<std::vector<double>> modelled = responses();
  std::vector<double> bands_kpa;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto stem = shown_stiction(logs[k].pressure_command_kpa, logs[k].displacement_mm,
                                     modelled.empty() ? std::vector<double>() : modelled[k]);
    if (!stem) return;
    bands_kpa.push_back(stem->band);
  }
  d.warnings.emplace_back(
      "In the closed loop, a sticking valve predicts the readings better than a valve that follows the "
      "command. The best prediction has a dead band of about " +
      with_commas(bands_kpa, [](double kpa) { return significant(kpa, 2); }) + " kPa");
  name_sticking_valve(d, std::move(bands_kpa));
}

bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings) {
  if (reading_count(records) <= enough_readings) return false;
  const double interval_s = averaged_interval_in_units * time_unit_s(records);
  bool any = false;
  for (Record& record : records) {
    Record averaged = averaged_to(record, interval_s);
    if (averaged.size() == record.size()) continue;
    warnings.push_back(record.name + ": " + significant(1 / record.mean_interval_s(), 3) +
                       " samples per second are more than the bandwidth of a finger requires, so the "
                       "diagnosis uses means over " +
                       significant(1e3 * averaged.mean_interval_s(), 2) +
                       " ms. The reported noise and errors are the noise and the errors of these means");
    record = std::move(averaged);
    any = true;
  }
  return any;
}

}  // namespace softgrip::sysid
