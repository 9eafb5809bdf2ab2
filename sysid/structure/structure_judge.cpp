#include "sysid/structure/structure_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"
#include "sysid/limits/limits.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {
namespace {

void repeat(std::vector<double>& column) {
  const auto size = static_cast<std::ptrdiff_t>(column.size());
  column.resize(2 * column.size());
  std::copy_n(column.begin(), size, column.begin() + size);
}

Record twice(Record record) {
  const std::size_t size = record.size();
  const double interval_s = record.mean_interval_s(), length_s = record.length_s() + interval_s;
  for (auto* column : {&record.time_s, &record.duration_s, &record.drive_kpa, &record.reading_mm,
                       &record.temperature_c, &record.supply_kpa})
    repeat(*column);
  record.duration_s[size] = step_duration_s(interval_s);
  for (std::size_t i = size; i < record.size(); ++i) record.time_s[i] += length_s;
  return record;
}

bool stays_bounded(const model::Model& model, const Record& record, const StartState& start) {
  double lowest_mm = std::numeric_limits<double>::infinity(), highest_mm = -lowest_mm;
  for (const double reading_mm : record.reading_mm) {
    if (!std::isfinite(reading_mm)) continue;
    lowest_mm = std::min(lowest_mm, reading_mm);
    highest_mm = std::max(highest_mm, reading_mm);
  }
  const double width_mm = highest_mm - lowest_mm;
  const std::vector<double> answer_mm = predict(model, twice(record), start);
  return std::all_of(answer_mm.begin(), answer_mm.end(),
                     [&](double y) { return y >= lowest_mm - width_mm && y <= highest_mm + width_mm; });
}

std::vector<double> with_rungs_between(const std::vector<double>& ladder_s) {
  std::vector<double> finer_s;
  for (const double tau_s : ladder_s) {
    if (!finer_s.empty()) finer_s.push_back(std::sqrt(finer_s.back() * tau_s));
    finer_s.push_back(tau_s);
  }
  return finer_s;
}

StructureFitOptions with_ridge(double ridge) {
  StructureFitOptions options;
  options.ridge = ridge;
  return options;
}

/// Returns the division without the beginnings of the records whose start is estimated. The readings of the
/// beginning are always fitted, because no other readings determine the start. Without them, a model with an
/// estimated start has a large error on the first block, regardless of its structure.
Division without_starts(Division division, const std::vector<Record>& records) {
  for (Block& block : division.blocks) {
    const Record& record = records[block.record];
    if (block.first > 0 || record.start == Start::rest || !record.offset_free) continue;
    const std::size_t gap = block.hidden_last - block.last;
    block.hidden_first = std::min(samples_for_start(record), block.last / 2);
    block.first = std::min(block.hidden_first + gap, block.last);
  }
  remove_unread_blocks(records, division);
  return division;
}

StructureTrial trial_of(const BaseStructure& structure) {
  StructureTrial trial;
  trial.structure = structure;
  return trial;
}

}  // namespace

bool stays_bounded(const FitPoint& point, const std::vector<Record>& records) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (!stays_bounded(point.model, records[r], point.starts[r])) return false;
  }
  return true;
}

StructureJudge::StructureJudge(const std::vector<Record>& records, const StructureChoiceOptions& options,
                               RungsBetween rungs)
    : records_(records),
      options_(options),
      grid_(grid_for(records)),
      division_(without_starts(divide_into_fifths(records), records)) {
  if (options.slow_from_s > 0) grid_.slow_from_s = options.slow_from_s;
  if (rungs == RungsBetween::yes) grid_.ladder_s = with_rungs_between(grid_.ladder_s);
}

FittedStructure StructureJudge::fit(const BaseStructure& structure, double ridge,
                                    const NonlinearNumbers* near) const {
  return fit_form(records_, structure, grid_, with_ridge(ridge), near);
}

StructureTrial StructureJudge::judge(const BaseStructure& structure, double ridge) const {
  return structure.published ? judge_published(structure) : judge(fit(structure, ridge), fold_iterations);
}

StructureTrial StructureJudge::trial_with(const FittedStructure& whole) const {
  StructureTrial trial = trial_of(whole.structure);
  trial.ridge = whole.ridge;
  trial.numbers = whole.numbers;
  trial.point = point_of(whole, records_, options_.drive);
  trial.rmse_mm = has_raised_creep(whole, records_) ? rmse_of(trial.point.model, trial.point.starts, records_)
                                                    : std::sqrt(whole.mean_square_mm2);
  trial.converged = whole.converged;
  trial.start_rmse_mm = whole.start_rmse_mm;
  return trial;
}

StructureTrial StructureJudge::judge(const FittedStructure& whole, int iterations) const {
  StructureTrial trial = trial_with(whole);
  StructureFitOptions options = with_ridge(whole.ridge);
  options.most_iterations = iterations;
  judge_held_out(trial, [&](const std::vector<Record>& rest) {
    const FittedStructure fit = fit_form(rest, trial.structure, grid_, options, &whole.numbers);
    return point_of(fit, rest, options_.drive);
  });
  return trial;
}

StructureTrial StructureJudge::judge_near(const BaseStructure& structure, double ridge,
                                          const NonlinearNumbers& numbers, double below_mm) const {
  const FittedStructure whole = fit(structure, ridge, &numbers);
  StructureTrial trial = trial_with(whole);
  if (!(trial.rmse_mm < below_mm)) return trial;
  return judge(whole, fold_iterations);
}

StructureTrial StructureJudge::judge_regulated(BaseStructure structure, const StructureTrial& lagging,
                                               double below_mm) const {
  structure.regulator = true;
  structure.second_lag = structure.rate_limit = false;
  return judge_near(structure, lagging.ridge, with_usual_regulator(lagging.numbers, grid_), below_mm);
}

bool StructureJudge::is_noise(const StructureTrial& trial) const {
  double noise_mm = std::numeric_limits<double>::infinity();
  for (const Record& record : records_) noise_mm = std::min(noise_mm, fast_noise_mm(record));
  return trial.heldout_rmse_mm <= (1 + limits::equal_error_share) * noise_mm;
}

StructureTrial StructureJudge::judge_resonant(const StructureTrial& still, ResonanceFit resonance_fit) const {
  StructureTrial trial = still;
  trial.structure.resonance = true;
  const ResonantFit ringing = with_resonance(still.point, records_, resonance_fit);
  trial.point = ringing.point;
  trial.rmse_mm = ringing.rmse_mm;
  StructureFitOptions options = with_ridge(still.ridge);
  options.most_iterations = fold_iterations;
  judge_held_out(trial, [&](const std::vector<Record>& rest) {
    const FittedStructure fit = fit_form(rest, still.structure, grid_, options, &still.numbers);
    return with_resonance_of(trial.point, point_of(fit, rest, options_.drive), rest, resonance_fit);
  });
  return trial;
}

StructureTrial StructureJudge::judge_published(const BaseStructure& structure) const {
  StructureTrial trial = trial_of(structure);
  PublishedElement found = fit_published(records_, options_.drive, options_.starts, options_.seed);
  trial.point = std::move(found.point);
  trial.rmse_mm = found.rmse_mm;
  trial.converged = found.converged;
  trial.invertible = rises_everywhere(trial.point.model);
  trial.start_rmse_mm = std::move(found.start_rmse_mm);
  judge_held_out(trial, [&](const std::vector<Record>& rest) { return refit_published(rest, trial.point); });
  return trial;
}

void StructureJudge::judge_held_out(StructureTrial& trial, const Refit& refit) const {
  trial.bounded = stays_bounded(trial.point, records_);
  trial.block_losses_mm2 = held_out_losses(records_, division_, refit);
  trial.heldout_rmse_mm = rmse_mm(trial.block_losses_mm2);
}

}  // namespace softgrip::sysid
