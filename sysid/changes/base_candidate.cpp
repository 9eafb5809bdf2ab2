#include "sysid/changes/base_candidate.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "sysid/changes/base_prediction.h"
#include "sysid/changes/regulator.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/resampled_record.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {
namespace {

BaseStructure play_structure(Drive drive, std::size_t modes = 0) {
  return {.hysteresis = HysteresisForm::play,
          .delay = drive == Drive::command,
          .hinged_creep = true,
          .modes = modes};
}

/// Fits a structure to records.
/// @param near  as for fit_form().
FittedParameters fitted(const BaseStructure& structure, const std::vector<Record>& driven, Drive drive,
                        const NonlinearNumbers* near = nullptr) {
  const FittedStructure fit = fit_form(driven, structure, grid_for(driven), {}, near);
  return {point_of(fit, driven, drive), fit.numbers};
}

/// Returns the candidate with this structure. Its input is the drive of the records that it is fitted to.
BaseCandidate candidate_of(const BaseStructure& structure, Drive drive) {
  return {description_of(structure),
          {},
          [=](const std::vector<Record>& driven) { return fitted(structure, driven, drive); },
          [=](const std::vector<Record>& driven, const FittedParameters& near) {
            return fitted(structure, driven, drive, &near.numbers).point;
          }};
}

/// Returns true if the start point of a linear mode already reduces the mean square error of play operators
/// and creep by more than 10 %. A complete fit of the mode is then worth its time.
/// @param still  play operators and creep without a mode, fitted to the records.
bool may_have_a_mode(const std::vector<Record>& records, Drive drive, const FittedParameters& still) {
  const StructureFitOptions options;
  const std::vector<Record> few = with_fewer_readings(records, options.most_rows);
  const StructureGrid grid = grid_for(few);
  StructureFitOptions held = options;
  held.most_iterations = 0;
  const FittedStructure play = fit_form(few, play_structure(drive), grid, held, &still.numbers);
  return starts_of_next_mode(few, play_structure(drive, 1), grid, still.numbers, options)
             .front()
             .mean_square_mm2 < (1 - limits::equal_error_share) * play.mean_square_mm2;
}

}  // namespace

FittedParameters for_records(FittedParameters parameters, const std::vector<std::size_t>& kept) {
  const auto reduce = [&kept](auto& of_records) {
    if (of_records.empty()) return;
    std::remove_reference_t<decltype(of_records)> reduced;
    for (const std::size_t r : kept) reduced.push_back(of_records[r]);
    of_records = std::move(reduced);
  };
  reduce(parameters.point.starts);
  reduce(parameters.numbers.peak_before_kpa);
  reduce(parameters.numbers.jumped_from_kpa);
  return parameters;
}

BaseCandidate play_candidate(Drive drive) {
  return candidate_of(play_structure(drive), drive);
}

std::vector<BaseCandidate> base_candidates(const std::vector<Record>& records, Judged judged, Drive drive,
                                           double largest_kpa, const BaseOptions& options) {
  if (judged == Judged::pressure) {
    const auto nothing = [](const std::vector<Record>&) { return FittedParameters{}; };
    const auto again = [](const std::vector<Record>&, const FittedParameters&) { return FitPoint{}; };
    return {{"filter bank", {}, nothing, again},
            {"a regulator", fit_regulator(records, largest_kpa, ReadBy::gauge), nothing, again}};
  }
  const BaseCandidate play = play_candidate(drive);
  const FittedParameters still = play.fit(records);
  std::vector<BaseCandidate> all{
      play,
      {"Bouc-Wen and two creep branches",
       {},
       [seed = options.seed, drive](const std::vector<Record>& driven) -> FittedParameters {
         return {fit_published(driven, drive, limits::repeated_starts, seed).point, {}};
       },
       [](const std::vector<Record>& driven, const FittedParameters& near) {
         return refit_published(driven, near.point);
       }}};
  all.front().fit = [still](const std::vector<Record>&) { return still; };
  if (drive == Drive::command) {
    const Regulator regulator = fit_regulator(records, largest_kpa);
    all.push_back({"a regulator, " + play.description, regulator, play.fit, play.refit});
  }
  if (may_have_a_mode(records, drive, still)) {
    const BaseStructure structure = play_structure(drive, 1);
    all.push_back(candidate_of(structure, drive));
    all.back().fit = [=](const std::vector<Record>& driven) {
      return fitted(structure, driven, drive, &still.numbers);
    };
  }
  if (options.given) {
    const model::Model model = deterministic_part(*options.given, drive);
    const auto given = [model](const std::vector<Record>& driven) {
      return FitPoint{model, rest_starts(model, driven)};
    };
    all.push_back(
        {"the given model",
         {},
         [given](const std::vector<Record>& driven) -> FittedParameters {
           return {given(driven), {}};
         },
         [given](const std::vector<Record>& driven, const FittedParameters&) { return given(driven); }});
  }
  return all;
}

Binned left_by(const BaseCandidate& candidate, const FitPoint& point, const std::vector<std::size_t>& kept,
               const std::vector<Record>& records, double bin_s) {
  const model::Model& model = point.model;
  std::vector<StartState> starts(records.size());
  if (!model.blocks.empty()) {
    for (std::size_t k = 0; k < kept.size(); ++k) starts[kept[k]] = point.starts[k];
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (std::find(kept.begin(), kept.end(), r) == kept.end()) starts[r] = start_of(model, records[r]);
    }
  }
  Binned left;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const std::vector<double> prediction = model.blocks.empty()
                                               ? without_model(candidate.regulator, records[r])
                                               : predict(model, records[r], starts[r]);
    left.push_back(binned(records[r], residual(records[r], prediction), bin_s));
  }
  return left;
}

LeftOutFit fit_without(const BaseCandidate& candidate, const FittedParameters& whole,
                       const std::vector<Record>& records, const Units& units, std::size_t unit,
                       double bin_s) {
  std::vector<std::size_t> kept;
  const std::vector<Record> rest = units.without(records, unit, &kept);
  const FitPoint point = candidate.refit(rest, for_records(whole, kept));
  return {point.model, left_by(candidate, point, kept, records, bin_s)};
}

}  // namespace softgrip::sysid
