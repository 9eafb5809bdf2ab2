#include "sysid/diagnosis/verdict/measured_valve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "base/parallel.h"
#include "base/statistics.h"
#include "model/line_loss.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

double length_s(const Log& log) {
  return log.time_s.back() - log.time_s.front();
}

double block_length_s(const std::vector<Log>& logs) {
  double interval_s = std::numeric_limits<double>::infinity(), longest_s = 0;
  for (const Log& log : logs) {
    interval_s = std::min(interval_s, length_s(log) / static_cast<double>(log.size()));
    longest_s = std::max(longest_s, length_s(log));
  }
  return block_length_in_units * time_unit_s(interval_s, longest_s);
}

double highest_kpa(const std::vector<Log>& logs) {
  double highest = 0;
  for (const Log& log : logs) {
    if (const auto extent = extent_of(log.pressure_kpa)) highest = std::max(highest, extent->highest);
  }
  return highest;
}

}  // namespace

MeasuredValve::MeasuredValve(const std::vector<Log>& logs, bool held)
    : logs_(logs), held_(held), block_s_(block_length_s(logs)) {
  for (const Log& log : logs_) {
    const auto blocks = std::max<std::size_t>(1, static_cast<std::size_t>(length_s(log) / block_s_));
    blocks_end_.push_back(blocks + (blocks_end_.empty() ? 0 : blocks_end_.back()));
    samples_ += log.size();
  }
}

ValveStage MeasuredValve::fit(ValveParts parts, const std::vector<ValveStage>& from,
                              PressureSensorFit sensor) const {
  return fit_valve_stage(logs_, fit_of(parts, from, sensor));
}

ValveStage MeasuredValve::exact_fit(ValveParts parts, const std::vector<ValveStage>& from) const {
  ValveFit fit = fit_of(parts, from, PressureSensorFit::gain_and_zero);
  fit.tolerance = ValveFit{}.tolerance;
  return fit_valve_stage(logs_, fit);
}

ValveStage MeasuredValve::better_fit(ValveParts parts, const ValveStage& one, const ValveStage& other) const {
  if (!(other.rmse_kpa < 1.5 * one.rmse_kpa)) return one;
  const ValveStage again = fit(parts, {other});
  return again.rmse_kpa < one.rmse_kpa ? again : one;
}

BlockLosses MeasuredValve::held_out_losses(ValveParts parts, const ValveStage& whole,
                                           PressureSensorFit sensor) const {
  BlockLosses losses(blocks_end_.back(), 0);
  std::vector<double> counts(losses.size(), 0);
  // The blocks are divided into two folds. Each fold consists of every second block.
  parallel_for_idle(2, [&](std::size_t fold) {
    ValveFit fit = fit_of(parts, {whole}, sensor);
    fit.is_fitted = [&](std::size_t log, std::size_t sample) { return block(log, sample) % 2 != fold; };
    const ValveStage stage = fit_valve_stage(logs_, fit);
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      const std::vector<double> p = predicted_pressure_kpa(stage, logs_[k], held_);
      for (std::size_t i = 0; i < p.size(); ++i) {
        const double error = p[i] - logs_[k].pressure_kpa[i];
        if (block(k, i) % 2 != fold || !std::isfinite(error)) continue;
        losses[block(k, i)] += error * error;
        ++counts[block(k, i)];
      }
    }
  });
  BlockLosses means;
  for (std::size_t b = 0; b < losses.size(); ++b) {
    if (counts[b] > 0) means.push_back(losses[b] / counts[b]);
  }
  return means;
}

Eigen::VectorXd MeasuredValve::standard_errors(const ValveStage& at,
                                               const std::vector<double ValveStage::*>& numbers) const {
  const auto n = static_cast<Eigen::Index>(numbers.size());
  const auto rows = static_cast<Eigen::Index>(samples_);
  Eigen::MatrixXd slopes(rows, n);
  for (Eigen::Index a = 0; a < n; ++a) slopes.col(a) = derivative(at, numbers[static_cast<std::size_t>(a)]);
  Eigen::VectorXd error = errors(at);
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (std::isfinite(error[row])) continue;
    error[row] = 0;
    slopes.row(row).setZero();
  }
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(blocks_end_.back()));
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    for (std::size_t i = 0; i < logs_[k].size(); ++i, ++row)
      scores.col(static_cast<Eigen::Index>(block(k, i))) += error[row] * slopes.row(row).transpose();
  }
  const Eigen::MatrixXd inverse =
      (slopes.transpose() * slopes).completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::VectorXd white = inverse.diagonal() * (error.squaredNorm() / static_cast<double>(rows));
  const Eigen::VectorXd sandwich = (inverse * scores * scores.transpose() * inverse).diagonal();
  return white.cwiseMax(sandwich).cwiseSqrt();
}

ValveFit MeasuredValve::fit_of(ValveParts parts, const std::vector<ValveStage>& from,
                               PressureSensorFit sensor) const {
  ValveFit fit;
  fit.parts = parts;
  fit.sensor = sensor;
  fit.held = held_;
  fit.from = from;
  fit.tolerance = 1e-6;
  return fit;
}

std::size_t MeasuredValve::block(std::size_t log, std::size_t sample) const {
  const std::size_t before = log == 0 ? 0 : blocks_end_[log - 1];
  const double at_s = logs_[log].time_s[sample] - logs_[log].time_s.front();
  return std::min(before + static_cast<std::size_t>(at_s / block_s_), blocks_end_[log] - 1);
}

Eigen::VectorXd MeasuredValve::errors(const ValveStage& stage) const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(samples_));
  Eigen::Index at = 0;
  for (const Log& log : logs_) {
    const std::vector<double> p = predicted_pressure_kpa(stage, log, held_);
    for (std::size_t i = 0; i < p.size(); ++i) all[at++] = p[i] - log.pressure_kpa[i];
  }
  return all;
}

Eigen::VectorXd MeasuredValve::derivative(const ValveStage& at, double ValveStage::*number) const {
  const double step = std::max(1e-3 * std::abs(at.*number), 1e-5);
  ValveStage above = at, below = at;
  above.*number += step;
  below.*number -= step;
  // If both time constants are equal, filling and venting share one time constant. Both members are then
  // changed together.
  if (number == &ValveStage::filling_s && at.filling_s == at.venting_s) {
    above.venting_s = above.filling_s;
    below.venting_s = below.filling_s;
  }
  return (errors(above) - errors(below)) / (2 * step);
}

std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs, const MeasuredValve& valve,
                                               ValveParts parts, const ValveStage& scaled) {
  if (!(scaled.gauge_gain < 1 - scales_agree_within)) return std::nullopt;
  LostPressure lost;
  const ValveStage without = valve.fit(parts, {scaled}, PressureSensorFit::zero);
  lost.without_kpa2 = valve.held_out_losses(parts, without, PressureSensorFit::zero);
  const BlockLosses by_scale = valve.held_out_losses(parts, scaled);
  lost.parts = parts.set(index_of(ValvePart::leak));
  ValveStage start = scaled;
  start.leak_share = 1 / scaled.gauge_gain - 1;
  lost.stage = valve.fit(lost.parts, {start}, PressureSensorFit::zero);
  lost.losses_kpa2 = valve.held_out_losses(lost.parts, lost.stage, PressureSensorFit::zero);
  const double before = square(rmse_mm(lost.without_kpa2)),
               taken = before - square(rmse_mm(lost.losses_kpa2));
  if (taken < limits::majority_share * before ||
      taken < (1 - limits::form_error_share) * (before - square(rmse_mm(by_scale))))
    return std::nullopt;
  lost.highest_kpa = highest_kpa(logs);
  lost.missing_kpa =
      model::LineLoss<double>{lost.stage.leak_share}.before(lost.highest_kpa) - lost.highest_kpa;
  return lost;
}

}  // namespace softgrip::sysid
