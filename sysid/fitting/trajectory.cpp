#include "sysid/fitting/trajectory.h"

#include <cmath>
#include <limits>

#include "base/thread_budget.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/slow_creep.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/fitting/trajectory_walk.h"

namespace softgrip::sysid {

void add_start(const model::Model& model, const Record& record, const StartState& start,
               std::vector<double>& series_mm) {
  for (double& y : series_mm) y += start.offset_mm;
  const std::vector<CreepBranch> branches = creep_branches(model);
  for (std::size_t b = 0; b < std::min(branches.size(), start.unsettled_mm.size()); ++b) {
    if (start.unsettled_mm[b] == 0) continue;
    for (std::size_t i = 0; i < record.size(); ++i) {
      series_mm[i] += start.unsettled_mm[b] *
                      std::exp(-(record.time_s[i] - record.time_s[0]) / branches[b].time_constant_s);
    }
  }
}

std::vector<double> predict(const model::Model& model, const Record& record, const StartState& start) {
  end_if_cancelled();
  std::vector<double> prediction(record.size());
  walk<double>(model, {}, record, start.peak_before_kpa, start,
               [&](std::size_t i, double y) { prediction[i] = y; });
  add_start(model, record, start, prediction);
  return prediction;
}

std::vector<double> residual(const Record& record, const std::vector<double>& prediction) {
  std::vector<double> difference(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) difference[i] = record.reading_mm[i] - prediction[i];
  return difference;
}

double rms_error(std::span<const double> readings_mm, std::span<const double> errors_mm) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < readings_mm.size(); ++i) {
    if (!std::isfinite(readings_mm[i])) continue;
    sum += errors_mm[i] * errors_mm[i];
    ++count;
  }
  if (count == 0) return 0;
  const double error_mm = std::sqrt(sum / static_cast<double>(count));
  return std::isfinite(error_mm) ? error_mm : std::numeric_limits<double>::infinity();
}

double rmse_of(const model::Model& model, const std::vector<StartState>& starts,
               const std::vector<Record>& records) {
  double sum = 0;
  std::size_t readings = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const double each =
        rms_error(records[r].reading_mm, residual(records[r], predict(model, records[r], starts[r])));
    sum += each * each * static_cast<double>(records[r].readings);
    readings += records[r].readings;
  }
  const double rmse = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(readings, 1)));
  return std::isfinite(rmse) ? rmse : std::numeric_limits<double>::infinity();
}

namespace {

std::vector<CreepBranch> kelvin_voigt_branches(const model::Model& model) {
  std::vector<CreepBranch> branches;
  const auto position = model::position_of<model::KelvinVoigt>(model);
  if (!position) return branches;
  const std::vector<double>& values = model.blocks[*position].values;
  for (std::size_t i = 1; i + 1 < values.size(); i += 2)
    branches.push_back({values[i + 1] / values[i], 1 / values[i]});
  return branches;
}

}  // namespace

std::vector<double> branch_time_constants_s(const model::Model& model) {
  std::vector<double> time_constants;
  for (const CreepBranch& branch : kelvin_voigt_branches(model))
    time_constants.push_back(branch.time_constant_s);
  return time_constants;
}

std::vector<CreepBranch> creep_branches(const model::Model& model) {
  std::vector<CreepBranch> branches = kelvin_voigt_branches(model);
  if (const auto slow = model::position_of<model::SlowCreep>(model)) {
    const std::vector<double>& values = model.blocks[*slow].values;
    branches.push_back({values[model::parameter_index<model::SlowCreep>("time_constant_s")],
                        values[model::parameter_index<model::SlowCreep>("gain_mm_per_kpa")]});
  }
  return branches;
}

}  // namespace softgrip::sysid
