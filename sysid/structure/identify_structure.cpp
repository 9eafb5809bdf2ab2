#include "sysid/structure/identify_structure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "base/parallel.h"
#include "base/text.h"
#include "base/thread_budget.h"
#include "sysid/fitting/residuals.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/estimates.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/division.h"
#include "sysid/logs/resampled_record.h"
#include "sysid/logs/signal_gaps.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_fit.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr std::size_t fewest_readings = 100;

StructureEvidence evidence_of(const StructureChoice& choice, const std::vector<WithoutIngredient>& ablation) {
  StructureEvidence evidence;
  evidence.ridge = choice.ridge;
  evidence.blocks = choice.blocks;
  for (std::size_t i = 0; i < choice.trials.size(); ++i) {
    const StructureTrial& t = choice.trials[i];
    evidence.candidates.push_back({std::string(name_of(t.structure)), description_of(t.structure), t.rmse_mm,
                                   t.heldout_rmse_mm, i == choice.chosen});
  }
  for (const WithoutIngredient& w : ablation)
    evidence.ablation.push_back(
        {std::string(name_of(w.ingredient)), w.trial.rmse_mm, w.trial.heldout_rmse_mm});
  return evidence;
}

std::string chosen_by_means(const std::vector<Record>& averaged) {
  double mean_s = 0;
  for (const Record& record : averaged) mean_s = std::max(mean_s, record.mean_interval_s());
  return "more than " + std::to_string(enough_readings) +
         " readings, so the structure was chosen with means of the readings over " +
         significant(1e3 * mean_s, 2) + " ms, and its parameters were fitted to all samples";
}

/// Adds the estimates of the free parameters to the result. A parameter that is 0 or at a bound has no
/// confidence interval.
void add_estimates(const StructureTrial& trial, Identification& result) {
  FitSpace space(trial.point.model, result.records, free_numbers(trial.point.model));
  space.hold_arrivals(trial.point.starts);
  const auto residuals = residuals_for(result.records, space);
  const std::vector<double> z = residuals->space().z(trial.point);
  const Uncertainty uncertainty = uncertainty_at(*residuals, z, std::numeric_limits<double>::infinity());
  const FittedPoint fit{*residuals, z, uncertainty};
  result.parameters = parameter_estimates(fit);
  for (Estimate& e : result.parameters) {
    if (!e.free) e.note = "fixed before the fit";
  }
  result.starts = start_estimates(fit);
  result.combinations = combination_estimates(fit);
  result.loose = uncertainty.loose;
  result.noise = uncertainty.noise;
}

void add_scores(const StructureTrial& trial, const std::vector<Record>& whole, Identification& result) {
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const Record& fitted = result.records[k];
    const StartState& start = trial.point.starts[k];
    result.scores.push_back(score_of(result.fitted, fitted, start, fitted.reading_mm));
    result.fast_noise_mm = std::max(result.fast_noise_mm, fast_noise_mm(whole[k]));
    if (fitted.readings == whole[k].readings) continue;
    std::vector<double> rest = whole[k].reading_mm;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (std::isfinite(fitted.reading_mm[i])) rest[i] = std::numeric_limits<double>::quiet_NaN();
    }
    result.held_out.push_back(score_of(result.fitted, whole[k], start, rest));
  }
}

void join_valve(const std::vector<Log>& logs, const IdentifyOptions& options, Identification& result) {
  const ValveStage stage = fit_valve_stage(logs, options.fit_share, options.record.held);
  StructureEvidence::Valve valve{
      stage.delay_s,      stage.filling_s,         stage.venting_s,          stage.rmse_kpa,
      stage.rmse_percent, stage.held_out_rmse_kpa, pressure_noise_kpa(logs), {}};
  // Valve and finger are simulated in series. The simulation of each log begins at the first measured
  // pressure of the log.
  std::vector<Log> driven = logs;
  for (Log& log : driven) log.pressure_kpa = predicted_pressure_kpa(stage, log, options.record.held);
  RecordOptions measured = options.record;
  measured.drive = Drive::measured;
  const std::vector<Record> records = make_records(driven, measured);
  for (std::size_t k = 0; k < records.size(); ++k) {
    valve.from_command.push_back(
        score_of(result.fitted, records[k], result.scores[k].start, logs[k].displacement_mm));
    // The pressure in `records` is the output of the valve model, so the input of this score is the command.
    valve.from_command.back().drive = Drive::command;
  }
  result.model = with_valve(result.fitted, stage);
  if (!stage.limits_reached.empty()) {
    result.warnings.push_back("the fit of the valve ended at the upper limit of the search, with a " +
                              enumerated(stage.limits_reached, " and a ") +
                              ". The logs are too short to determine these values, or the measured pressure "
                              "does not follow the command");
  } else if (stage.is_far_off()) {
    result.warnings.push_back(
        "a model of dead time and lag does not describe the valve. The difference between this model and the "
        "measured pressure is " +
        significant(stage.rmse_kpa, 3) + " kPa RMS, " + significant(stage.rmse_percent, 2) +
        " % of the pressure range");
  }
  result.structure->valve = std::move(valve);
}

/// Warns about a drive whose largest magnitude is a pressure below zero. Envelopes, characteristic and
/// pressure-dependent creep act only at positive pressures or displacements.
void warn_of_vacuum(Identification& result) {
  double lowest_kpa = 0, highest_kpa = 0;
  for (const Record& record : result.records) {
    const auto [low, high] = std::minmax_element(record.drive_kpa.begin(), record.drive_kpa.end());
    lowest_kpa = std::min(lowest_kpa, *low);
    highest_kpa = std::max(highest_kpa, *high);
  }
  if (!(-lowest_kpa > highest_kpa)) return;
  result.warnings.push_back(
      "the pressures reach from " + significant(lowest_kpa, 3) + " to " + significant(highest_kpa, 3) +
      " kPa. The model can describe a nonlinear envelope, a nonlinear characteristic and pressure-dependent "
      "creep only for positive pressures and displacements, so the error may be larger than necessary. Fit a "
      "copy of the logs with inverted signs of pressure and displacement to see the difference");
}

void add_warnings(Identification& result) {
  warn_of_vacuum(result);
  if (!result.converged) result.warnings.emplace_back("the search stopped before convergence");
  if (const double ratio = beta_over_gain(result.fitted); ratio > 1)
    result.warnings.push_back(wrong_way_sentence(ratio) + ". Run softgrip diagnose");
  for (std::string& sentence : start_warnings(result)) result.warnings.push_back(std::move(sentence));
}

}  // namespace

tl::expected<Identification, std::string> identify_structure(const std::vector<Log>& logs,
                                                             StructureQuestion question,
                                                             const IdentifyOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  if (logs.empty()) return Failure("no logs for the identification");
  const ThreadBudget budget(options.threads);
  const bool measured =
      std::all_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
  if (options.record.drive == Drive::measured && !measured) return Failure("a log has no measured pressure");
  std::string gap;
  for (const Log& log : logs) {
    const auto found = measured && gap.empty() ? pressure_gap(log) : std::nullopt;
    if (found) gap = log.name + ": " + gap_sentence(log, *found);
  }
  const bool two_stages = options.record.drive == Drive::command && measured && gap.empty();
  RecordOptions record = options.record;
  if (two_stages) record.drive = Drive::measured;

  const std::vector<Record> whole = make_records(logs, record);
  Identification result;
  if (!gap.empty())
    result.warnings.push_back(gap + ". The fit uses the command and no separate model of the valve");
  result.records = with_first_readings(whole, options.fit_share);
  std::size_t readings = 0;
  for (const Record& each : result.records) readings += each.readings;
  if (readings < fewest_readings)
    return Failure("only " + std::to_string(readings) +
                   " readings to fit, which is too few to choose a structure (" +
                   std::to_string(fewest_readings) + " are needed)");

  StructureChoiceOptions choice_options;
  choice_options.question = question;
  choice_options.drive = record.drive;
  choice_options.dynamics = true;
  choice_options.starts = options.starts;
  choice_options.seed = options.seed;
  choice_options.threads = options.threads;
  if (options.progress) {
    choice_options.progress = [&](const std::string& stage) { options.progress({0, 0, 0, stage}); };
  }
  const std::vector<Record> fewer =
      with_simplest_start(averaged_to_count(result.records, enough_readings,
                                            limits::search_interval_in_units * time_unit_s(whole)),
                          choice_options);
  for (std::size_t k = 0; k < fewer.size(); ++k) result.records[k].start_unknown = fewer[k].start_unknown;
  const StructureChoice choice = choose_structure(fewer, choice_options);
  StructureTrial chosen = choice.trials[choice.chosen];
  if (!std::isfinite(chosen.rmse_mm))
    return Failure("the prediction of the model is infinite or NaN for every start point of the fit");
  // Most of the fit to all readings runs on one thread, and the ablation does not need its result.
  std::vector<WithoutIngredient> ablation;
  parallel_for(2, options.threads, [&](std::size_t part) {
    if (part == 0) {
      ablation = ablation_of(fewer, choice, choice_options);
      return;
    }
    if (readings > enough_readings) chosen = fitted_to(std::move(chosen), result.records, record.drive);
    result.fitted = chosen.point.model;
    result.fitted.name = "identified";
    add_scores(chosen, whole, result);
    add_estimates(chosen, result);
  });
  result.structure = evidence_of(choice, ablation);
  result.model = result.fitted;
  result.rmse_mm = chosen.rmse_mm;
  result.converged = chosen.converged;
  result.multistart = multistart_of(chosen.start_rmse_mm);
  if (readings > enough_readings) result.warnings.push_back(chosen_by_means(fewer));
  add_warnings(result);
  if (two_stages) join_valve(logs, options, result);
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

}  // namespace softgrip::sysid
