#include "sysid/structure/structure_choice.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "sysid/evidence/comparison.h"
#include "sysid/fitting/held_out.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/identify.h"
#include "sysid/limits/limits.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/resonance.h"
#include "sysid/structure/structure_fit.h"
#include "sysid/structure/structure_judge.h"

namespace softgrip::sysid {
namespace {

constexpr std::array ridges{1e-7, 1e-6, 1e-5, 1e-4, 1e-3};
/// Index of the ridge parameter whose fit starts from all start points. The fits with the other ridge
/// parameters start at the nonlinear parameters of this fit.
constexpr std::size_t first_ridge = 2;
/// Largest number of linear modes. Each mode has two poles, so three modes have as many poles as a linear
/// output-error model of order 6.
constexpr std::size_t most_modes = 3;

/// Returns the candidate structures. The first one is the simplest.
std::vector<BaseStructure> candidates(const StructureChoiceOptions& options) {
  const bool delay = options.drive == Drive::command;
  std::vector<BaseStructure> list;
  const auto ladder = [delay](HysteresisForm hysteresis, bool bent, bool hinged) {
    return BaseStructure{
        .hysteresis = hysteresis, .delay = delay, .characteristic = bent, .hinged_creep = hinged};
  };
  if (options.question != StructureQuestion::prandtl_ishlinskii) {
    list.push_back({.hysteresis = HysteresisForm::bouc_wen,
                    .delay = delay,
                    .lag = delay,
                    .two_way = false,
                    .characteristic = false,
                    .published = true});
    for (const bool bent : {false, true}) list.push_back(ladder(HysteresisForm::bouc_wen, bent, false));
  }
  if (options.question != StructureQuestion::bouc_wen) {
    for (const bool bent : {false, true}) list.push_back(ladder(HysteresisForm::play, bent, false));
    list.push_back(ladder(HysteresisForm::play, true, false));
    list.back().envelopes = true;
    list.push_back(ladder(HysteresisForm::play, true, true));
  }
  return list;
}

bool is_evaluated(const StructureTrial& trial) {
  return !trial.block_losses_mm2.empty();
}

bool may_be_chosen(const StructureTrial& trial) {
  return is_evaluated(trial) && trial.invertible && trial.bounded;
}

std::size_t best_of(const std::vector<StructureTrial>& trials) {
  return static_cast<std::size_t>(std::min_element(trials.begin(), trials.end(),
                                                   [](const StructureTrial& a, const StructureTrial& b) {
                                                     if (may_be_chosen(a) != may_be_chosen(b))
                                                       return may_be_chosen(a);
                                                     return a.heldout_rmse_mm < b.heldout_rmse_mm;
                                                   }) -
                                  trials.begin());
}

/// If the loss of a trial is clearly lower than the loss of the selected trial, adds it to the choice and
/// selects it. An extension must reduce the loss in more than one block. A structure without the extension,
/// in contrast, is already rejected by simplest_of_the_best() if it fails in one block. Returns true if the
/// trial is selected.
bool offer(StructureTrial trial, StructureChoice& choice) {
  if (!may_be_chosen(trial) ||
      !is_clearly_less(trial.block_losses_mm2, choice.trials[choice.chosen].block_losses_mm2))
    return false;
  choice.chosen = choice.trials.size();
  choice.trials.push_back(std::move(trial));
  return true;
}

/// Adds an extension to a structure and evaluates the extended structure. The second argument is the trial
/// of the chosen structure.
using Extension = std::function<StructureTrial(const BaseStructure&, const StructureTrial&)>;

/// Evaluates a chosen structure with an extension. Pressure-dependent creep may have compensated for a
/// missing extension. Therefore the extended structure is evaluated a second time without
/// pressure-dependent creep. Returns the better trial.
StructureTrial extended_by(const Extension& extension, const StructureTrial& chosen) {
  std::vector<BaseStructure> structures{chosen.structure};
  if (chosen.structure.hinged_creep)
    structures.insert(structures.begin(), without(chosen.structure, Ingredient::pressure_dependent_creep));
  std::vector<StructureTrial> trials(structures.size());
  parallel_for_idle(structures.size(), [&](std::size_t i) { trials[i] = extension(structures[i], chosen); });
  return std::move(trials[simplest_of_the_best(trials)]);
}

/// Offers extensions of the chosen structure, one after the other. All extensions are evaluated at the same
/// time. If one of them is selected, the extensions after it are evaluated again with the new choice.
void offer_in_order(std::span<const Extension> extensions, unsigned threads, StructureChoice& choice) {
  while (!extensions.empty()) {
    const StructureTrial chosen = choice.trials[choice.chosen];
    std::vector<StructureTrial> trials(extensions.size());
    parallel_for(extensions.size(), threads,
                 [&](std::size_t i) { trials[i] = extended_by(extensions[i], chosen); });
    std::size_t offered = 0;
    while (offered < trials.size() && !offer(std::move(trials[offered]), choice)) ++offered;
    extensions = extensions.subspan(std::min(offered + 1, extensions.size()));
  }
}

/// Tries the extensions of the chosen structure, one after the other.
void offer_extensions(const StructureJudge& judge, const StructureChoiceOptions& options,
                      StructureChoice& choice) {
  const auto say = [&](const std::string& text) {
    if (options.progress) options.progress(text);
  };
  // An extension has more parameters. If it does not reduce the error of the fit to all readings, it does not
  // reduce the error on held-out readings.
  const auto below_mm = [](const StructureTrial& chosen) {
    return (1 - limits::negligible_share) * chosen.rmse_mm;
  };
  std::vector<Extension> extensions;
  if (options.drive == Drive::command && options.dynamics) {
    extensions.emplace_back([&](BaseStructure structure, const StructureTrial& chosen) {
      structure.second_lag = true;
      return judge.judge_near(structure, chosen.ridge, chosen.numbers, below_mm(chosen));
    });
    extensions.emplace_back([&](BaseStructure structure, const StructureTrial& chosen) {
      structure.second_lag = false;
      structure.rate_limit = true;
      return judge.judge_near(structure, chosen.ridge, chosen.numbers, below_mm(chosen));
    });
  }
  if (options.drive == Drive::command) {
    extensions.emplace_back([&](const BaseStructure& structure, const StructureTrial& chosen) {
      return judge.judge_regulated(structure, chosen, below_mm(chosen));
    });
    say(options.dynamics ? "trying a second lag, a rate limit and a regulator"
                         : "trying a regulator instead of the lag");
  }
  offer_in_order(extensions, options.threads, choice);
  if (options.dynamics) {
    say("trying a resonance");
    // The complete fit takes as long as all other trials together. The fast fit therefore decides whether the
    // complete fit is made.
    const StructureTrial still = choice.trials[choice.chosen];
    const StructureTrial screening = judge.judge_resonant(still, ResonanceFit::dynamics);
    if (is_clearly_less(screening.block_losses_mm2, still.block_losses_mm2))
      offer(judge.judge_resonant(still, ResonanceFit::complete), choice);
  }
}

/// Adds linear modes to a structure, one after the other, while the held-out loss becomes significantly
/// lower. Returns the extended structures that may be offered.
/// @param form  trial of the structure without modes. If it has other dynamics, each mode must reduce the
/// error by at least 10 %, because modes can imitate small errors of the other components. A linear structure
/// without modes has no dynamics, so a second mode is tried even if the first one alone does not lower the
/// loss. A linear structure is not evaluated if its fit to all readings has a larger error than the held-out
/// error of the chosen structure.
std::vector<StructureTrial> with_modes(const StructureJudge& judge, StructureTrial form, double ridge) {
  constexpr double reduced = 1 - limits::equal_error_share;
  const bool alone = form.structure.linear;
  const double heldout_of_chosen_mm = form.heldout_rmse_mm;
  std::vector<StructureTrial> found;
  for (std::size_t modes = 1; modes <= most_modes; ++modes) {
    BaseStructure structure = form.structure;
    structure.modes = modes;
    StructureTrial extended = judge.judge_near(structure, ridge, form.numbers,
                                               alone ? heldout_of_chosen_mm : reduced * form.rmse_mm);
    bool is_lower = alone && extended.rmse_mm < reduced * form.rmse_mm;
    if (is_evaluated(extended) && is_evaluated(form)) {
      is_lower = is_clearly_less(extended.block_losses_mm2, form.block_losses_mm2) &&
                 (alone || extended.heldout_rmse_mm < reduced * form.heldout_rmse_mm);
    }
    if (is_evaluated(extended) && (alone || is_lower)) found.push_back(extended);
    if (!is_lower && !(alone && modes == 1)) break;
    form = std::move(extended);
  }
  return found;
}

/// Tries linear modes in two forms: alone, and in parallel with the chosen structure. Neither form is tried
/// if the error of the chosen structure is noise.
void offer_linear_modes(const StructureJudge& judge, const StructureChoiceOptions& options,
                        StructureChoice& choice) {
  const std::vector<StructureTrial>& trials = choice.trials;
  if (judge.is_noise(trials[choice.chosen])) return;
  if (options.progress) options.progress("trying linear modes");
  StructureTrial still = trials[choice.chosen];
  if (still.structure.published)
    still = *std::find_if(trials.begin(), trials.end(),
                          [](const StructureTrial& t) { return !t.structure.published; });
  StructureTrial alone = still;
  alone.structure = {.hysteretic = false,
                     .delay = still.structure.delay,
                     .lag = false,
                     .two_way = false,
                     .characteristic = false,
                     .linear = true};
  still.structure.resonance = false;
  const std::array forms{std::move(alone), std::move(still)};
  std::array<std::vector<StructureTrial>, forms.size()> extended;
  parallel_for(forms.size(), options.threads,
               [&](std::size_t i) { extended[i] = with_modes(judge, forms[i], choice.ridge); });
  for (std::vector<StructureTrial>& found : extended) {
    for (StructureTrial& trial : found) offer(std::move(trial), choice);
  }
}

/// Returns the trial of a candidate; nullptr if no candidate has this structure.
const StructureTrial* candidate_with(const BaseStructure& structure, const StructureChoice& choice) {
  const auto trials = std::span(choice.trials).first(choice.candidates);
  const auto found = std::find_if(trials.begin(), trials.end(),
                                  [&](const StructureTrial& t) { return t.structure == structure; });
  return found == trials.end() ? nullptr : &*found;
}

/// Fits the structure of a trial.
/// @param near  start point of the nonlinear parameters; nullptr: the search starts from all default start
/// points.
FitPoint fit_from(const NonlinearNumbers* near, const StructureTrial& trial,
                  const std::vector<Record>& records, Drive drive, StructureFitOptions options = {}) {
  if (trial.structure.published) return refit_published(records, trial.point);
  options.ridge = trial.ridge;
  return point_of(fit_form(records, trial.structure, grid_for(records), options, near), records, drive);
}

}  // namespace

std::size_t simplest_of_the_best(const std::vector<StructureTrial>& trials) {
  constexpr std::uint64_t seed = 1;
  const std::size_t best = best_of(trials);
  const std::vector<double>& lowest_mm2 = trials[best].block_losses_mm2;
  const std::vector<double> equal_weights(lowest_mm2.size(), 1);
  for (std::size_t i = 0; i < best; ++i) {
    if (may_be_chosen(trials[i]) &&
        !is_better(compare({trials[i].block_losses_mm2, lowest_mm2, equal_weights}, 0, seed)))
      return i;
  }
  return best;
}

std::vector<Record> with_simplest_start(const std::vector<Record>& records,
                                        const StructureChoiceOptions& options) {
  const auto is_open = [](const Record& r) { return r.start == Start::automatic && r.start_unknown; };
  if (std::none_of(records.begin(), records.end(), is_open)) return records;
  std::vector<Record> resting = records;
  for (Record& record : resting) record.start_unknown = record.start_unknown && !is_open(record);
  if (options.progress) options.progress("checking whether each log begins at rest");
  const BaseStructure structure = candidates(options).back();
  std::array<std::vector<double>, 2> losses;
  parallel_for(losses.size(), options.threads, [&](std::size_t i) {
    losses[i] = StructureJudge(i == 0 ? resting : records, options)
                    .judge(structure, ridges[first_ridge])
                    .block_losses_mm2;
  });
  return is_clearly_less(losses[1], losses[0]) ? records : resting;
}

StructureChoice choose_structure(const std::vector<Record>& records, const StructureChoiceOptions& options) {
  const StructureJudge judge(records, options);
  const std::vector<BaseStructure> structures = candidates(options);
  const auto say = [&](const std::string& text) {
    if (options.progress) options.progress(text);
  };
  StructureChoice choice;
  choice.blocks = judge.blocks();
  const BaseStructure& richest = structures.back();
  std::vector<FittedStructure> fitted_with(ridges.size());
  std::vector<StructureTrial> by_ridge(ridges.size());
  say("choosing the ridge parameter");
  fitted_with[first_ridge] = judge.fit(richest, ridges[first_ridge]);
  parallel_for(ridges.size(), options.threads, [&](std::size_t i) {
    if (i != first_ridge) fitted_with[i] = judge.fit(richest, ridges[i], &fitted_with[first_ridge].numbers);
    by_ridge[i] = judge.judge(fitted_with[i], 0);
  });
  const std::size_t best_ridge = best_of(by_ridge);
  choice.ridge = ridges[best_ridge];
  std::atomic<std::size_t> done{0};
  choice.trials.resize(structures.size());
  parallel_for(structures.size(), options.threads, [&](std::size_t i) {
    choice.trials[i] = i + 1 == structures.size()
                           ? judge.judge(fitted_with[best_ridge], StructureJudge::fold_iterations)
                           : judge.judge(structures[i], choice.ridge);
    say("structures: " + std::to_string(++done) + " of " + std::to_string(structures.size()) + " evaluated");
  });
  choice.candidates = choice.trials.size();
  choice.chosen = simplest_of_the_best(choice.trials);
  if (!choice.trials[choice.chosen].structure.published) offer_extensions(judge, options, choice);
  if (options.dynamics) offer_linear_modes(judge, options, choice);
  return choice;
}

StructureTrial fitted_to(StructureTrial trial, const std::vector<Record>& records, Drive drive) {
  StructureTrial still = trial;
  const bool rings = std::exchange(still.structure.resonance, false);
  FitPoint point =
      fit_from(&trial.numbers, still, records, drive, {.most_iterations = StructureJudge::fold_iterations});
  trial.point = rings ? with_resonance_of(trial.point, std::move(point), records, ResonanceFit::complete)
                      : std::move(point);
  trial.rmse_mm = rmse_of(trial.point.model, trial.point.starts, records);
  return trial;
}

std::vector<WithoutIngredient> ablation_of(const std::vector<Record>& records, const StructureChoice& choice,
                                           const StructureChoiceOptions& options,
                                           std::span<const Ingredient> ingredients) {
  std::vector<WithoutIngredient> ablation;
  const StructureTrial& chosen = choice.trials[choice.chosen];
  if (chosen.structure.published) return ablation;
  if (options.progress) options.progress("removing one component at a time");
  for (const Ingredient ingredient : ingredients) {
    if (!has(chosen.structure, ingredient)) continue;
    ablation.push_back({ingredient, {}});
    ablation.back().trial.structure = without(chosen.structure, ingredient);
  }
  const StructureJudge judge(records, options);
  const StructureJudge among_more_rungs(records, options, RungsBetween::yes);
  parallel_for(ablation.size(), options.threads, [&](std::size_t i) {
    if (const StructureTrial* known = candidate_with(ablation[i].trial.structure, choice)) {
      ablation[i].trial = *known;
      return;
    }
    // If slow creep is removed, the chain of creep branches gets intermediate time constants. The finger may
    // have creep whose time constant lies between two time constants of the chain. Both branches then
    // represent this creep together, and the slower branch may count as slow creep.
    const StructureJudge& fair = ablation[i].ingredient == Ingredient::slow_creep ? among_more_rungs : judge;
    BaseStructure still = ablation[i].trial.structure;
    const bool rings = std::exchange(still.resonance, false);
    StructureTrial trial = (still.lag && still.regulator) || still.modes > 0
                               ? fair.judge_near(still, choice.ridge, chosen.numbers)
                               : fair.judge(still, choice.ridge);
    ablation[i].trial = rings ? fair.judge_resonant(trial, ResonanceFit::complete) : std::move(trial);
  });
  return ablation;
}

FitPoint fit_again(const StructureTrial& trial, const std::vector<Record>& records, Drive drive) {
  // If there is a regulator, the fit starts at the parameters of the trial. A search for the parameters of a
  // regulator takes long. It is not necessary, because these parameters do not depend on the finger.
  return fit_from(trial.structure.regulator ? &trial.numbers : nullptr, trial, records, drive);
}

FitPoint fit_nearby(const StructureTrial& trial, const std::vector<Record>& records, Drive drive) {
  return fit_from(&trial.numbers, trial, records, drive);
}

}  // namespace softgrip::sysid
