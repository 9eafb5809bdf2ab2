#include "sysid/diagnosis/verdict/base_findings.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "base/statistics.h"
#include "model/named.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/linear_selection.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/fitting/held_out.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"
#include "sysid/limits/limits.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_choice.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {
namespace {

/// Largest ridge parameter when causes are added to a richer base structure. While a cause is missing, the
/// choice of the ridge parameter and of the simplest structure is unreliable.
constexpr double most_ridge = 1e-5;

/// Returns true if the richer base structure predicts better than the given one. Both structures are fitted
/// to the first half of each log and then predict the second half. Returns true too if the given model has an
/// inverse response, because no finger has an inverse response.
bool foretells_better(const std::vector<Record>& records, const StructureTrial& chosen, const FitPoint& given,
                      Drive drive) {
  if (beta_over_gain(given.model) > 1) return true;
  const Division halves = divide_into_halves(records);
  const BlockLosses before = held_out_losses(
      records, halves, [&](const std::vector<Record>& rest) { return fit_structure(rest, {}, given).point; });
  const BlockLosses with = held_out_losses(
      records, halves, [&](const std::vector<Record>& rest) { return fit_again(chosen, rest, drive); });
  return rmse_mm(with) < (1 - limits::equal_error_share) * rmse_mm(before);
}

double slowest_branch_s(const model::Model& model) {
  double slowest_s = 0;
  for (const double tau_s : branch_time_constants_s(model)) slowest_s = std::max(slowest_s, tau_s);
  return slowest_s;
}

/// Returns the smallest time constant of slow creep [s]. The slowest time constants of the given and of the
/// refitted model are compared, and the result is twice the smaller one. It is limited to the range from 10 %
/// to 100 % of the longest record. The smaller value is used for two reasons. The branches of the given model
/// may be too fast if they compensate for a missing component. The refit may have moved a branch to the time
/// constant of a missing slow branch.
double slow_from_s(const SearchData& data, const model::Model& recalibrated) {
  const double longest_s = campaign_size(data.records).longest_s;
  const double slowest_s = std::min(slowest_branch_s(data.given.model), slowest_branch_s(recalibrated));
  return std::max(longest_s / 10, std::min(2 * slowest_s, longest_s));
}

/// A structure that predicts better than the given structure. The ablation contains its fits without one of
/// its components.
struct BetterStructure {
  StructureTrial chosen;
  std::vector<WithoutIngredient> ablation;
};

std::optional<BetterStructure> better_structure(const std::vector<Record>& records, const FitPoint& given,
                                                const StructureChoiceOptions& options) {
  const StructureChoice choice = choose_structure(records, options);
  const StructureTrial& chosen = choice.trials[choice.chosen];
  // The published element (Bouc-Wen with two Kelvin-Voigt branches) with delay and lag is not accepted as a
  // richer structure. It equals the given base structure with two causes, and the search for causes already
  // tests these causes.
  if (chosen.structure.published || !foretells_better(records, chosen, given, options.drive))
    return std::nullopt;
  return BetterStructure{chosen, ablation_of(records, choice, options, named_ingredients())};
}

/// Returns true if one of `causes` is confounded with the cause of `finding`. The base structure may then
/// contain the effect of this cause.
bool is_confounded(const NamedCause& finding, const std::vector<Cause>& causes) {
  return std::any_of(causes.begin(), causes.end(),
                     [&](const Cause& cause) { return cause.is_confounded_with(finding.cause); });
}

void take_back_confounded(BaseFindings& found, const SearchData& data, const BaseQuestion& question) {
  std::erase_if(found.named, [&](const NamedCause& finding) {
    if (!is_confounded(finding, found.fit.causes)) return false;
    FitPoint rest = found.fit.point;
    rest.model = model::without_block(std::move(rest.model), finding.block_type);
    StructureFit fit = fit_structure(data.records, found.fit.causes, rest, finishing_effort);
    BlockLosses losses = linear_held_out_losses(data.records, question.division, fit);
    if (is_missed(losses, found.losses, limits::negligible_share * square(question.noise_mm), question.seed))
      return false;
    found.fit = std::move(fit);
    found.losses = std::move(losses);
    return true;
  });
}

/// Computes the parameters of all named causes again, from the fit that contains all causes.
void renumber(BaseFindings& found, const SearchData& data) {
  const FitSpace space = structure_space(data.records, found.fit.point.model, found.fit.causes);
  const UncertainPoint at = uncertain_point(data.records, found.fit.point, space);
  for (NamedCause& named : found.named) {
    if (model::position_of(found.fit.point.model, named.block_type))
      named.parameters = block_numbers(at, named.block_type);
  }
}

/// Fits the structure to the original readings with free time constants. During the choice of the structure,
/// the time constants had fixed trial values. A cause would absorb the error of these trial values.
StructureFit fit_off_grid(const StructureTrial& trial, const SearchData& data, Drive drive) {
  return fit_structure(data.records, {}, fit_again(trial, data.records, drive), finishing_effort);
}

/// Tests if the nonlinear characteristic is needed, in the same way as for the other components. The choice
/// of the structure had left it out, because the simpler structure was equally good.
/// @param straight  base structure without the nonlinear characteristic.
void name_the_bend(BaseFindings& found, StructureTrial straight, const BaseSearch& search) {
  const StructureFit fit = fit_off_grid(straight, search.data, search.question.drive);
  straight.block_losses_mm2 = linear_held_out_losses(search.data.records, search.question.division, fit);
  name_ingredients(found, {{Ingredient::characteristic, std::move(straight)}}, search);
}

/// Refits the base structure without causes. The free parameters are the same as in the fit with a cause.
/// With fewer free parameters, the error reduction by the additional parameters would be attributed to the
/// cause. The refit is used only if its loss is lower than the current one.
void free_the_base(BaseFindings& found, const StructureTrial& as_beside_causes, const BaseSearch& search) {
  const auto& [data, plain, question] = search;
  const bool is_free = found.chosen.structure == as_beside_causes.structure &&
                       found.chosen.ridge == as_beside_causes.ridge && found.off_grid;
  if (is_free) return;
  StructureFit fit = fit_off_grid(as_beside_causes, data, question.drive);
  BlockLosses losses = linear_held_out_losses(data.records, question.division, fit);
  if (!(rmse_mm(losses) < rmse_mm(found.losses))) return;
  found.fit = std::move(fit);
  found.losses = std::move(losses);
  found.description = description_of(as_beside_causes.structure);
  const bool was_straight = !found.chosen.structure.characteristic;
  found.off_grid = true;
  found.chosen = as_beside_causes;
  found.chosen.point = found.fit.point;
  found.chosen.block_losses_mm2 = found.losses;
  if (was_straight) {
    StructureTrial straight = as_beside_causes;
    straight.structure.characteristic = false;
    name_the_bend(found, std::move(straight), search);
  }
  renumber(found, data);
}

/// Removes a cause from the alternatives of all findings if the cause is itself found.
void take_back_alternatives(BaseFindings& found) {
  for (NamedCause& finding : found.named) {
    std::erase_if(finding.alternatives, [&](const Cause& alternative) {
      return std::find(found.fit.causes.begin(), found.fit.causes.end(), alternative) !=
             found.fit.causes.end();
    });
  }
}

/// Removes causes that are not needed. The base structure was refitted together with the causes, so it may
/// now have a small error without them. A cause is kept only if the loss is significantly larger after a
/// refit without the cause.
/// @param losses  held-out losses of `with`.
void drop_what_is_not_missed(StructureFit& with, BlockLosses& losses, std::vector<ChosenCause>& chosen,
                             const SearchData& data, const BaseQuestion& question) {
  std::erase_if(chosen, [&](const ChosenCause& one) {
    StructureFit rest = fit_without_cause(data.records, with, one.cause, finishing_effort);
    BlockLosses without = linear_held_out_losses(data.records, question.division, rest);
    // A cause is kept if its removal increases the held-out mean square by more than the noise variance.
    if (is_missed(without, losses, square(question.noise_mm), question.seed)) return false;
    with = std::move(rest);
    losses = std::move(without);
    return true;
  });
}

/// Returns true if the causes on the richer base structure are a proper subset of the causes on the given
/// base structure. The set must not be empty.
bool has_some_of(const BaseFindings& found, const Selection& plain) {
  const std::vector<Cause>&some = found.fit.causes, &all = plain.extended.causes;
  const auto is_in_all = [&](const Cause& cause) {
    return std::find(all.begin(), all.end(), cause) != all.end();
  };
  return !some.empty() && some.size() < all.size() && std::all_of(some.begin(), some.end(), is_in_all);
}

/// Selects causes with thinned records, because a fit of a base structure with many parameters takes long.
/// Thinned records are sufficient to find out which causes are present.
Selection select_among_thinned(const FitPoint& base, const SearchData& data, const BaseQuestion& question,
                               const SelectionOptions& options) {
  SearchData thinned = data;
  thinned.records = data.thinned;
  thinned.thinned = data.glimpsed;
  const Division division = thinned_like(question.division, data.records, data.thinned);
  return select_causes_upon(thinned, evaluate_structure(thinned.records, {}, base), question.noise_mm,
                            division, options);
}

}  // namespace

std::optional<BaseFindings> find_base(const BaseSearch& search) {
  const SearchData& data = search.data;
  const Selection& plain = search.plain;
  const BaseQuestion& question = search.question;
  StructureChoiceOptions options;
  options.drive = question.drive;
  options.slow_from_s = slow_from_s(data, plain.base.point.model);
  options.seed = question.seed;
  options.threads = question.threads;
  options.progress = question.progress;
  options.starts = limits::repeated_starts;
  // An effect that no structure contains may increase the errors of all structures. Therefore the search is
  // repeated with modified readings: first without the effects of the causes that were found, and then
  // without a drift.
  using Readings = std::vector<Record>;
  std::vector<std::function<Readings(const Readings&)>> views{std::identity{}};
  if (!plain.extended.causes.empty()) {
    views.emplace_back([&](const Readings& all) {
      return without_effects(all, plain.extended.point, plain.extended.causes);
    });
  }
  views.emplace_back([&](const Readings& all) {
    return without_zero_drift(all, {.delay = question.drive == Drive::command}, {});
  });
  std::optional<BetterStructure> better;
  auto view = views.begin();
  for (; view != views.end(); ++view) {
    better = better_structure((*view)(data.thinned), plain.base.point, options);
    if (better) break;
  }
  if (!better) return std::nullopt;
  const StructureTrial& chosen = better->chosen;
  BaseFindings found;
  found.chosen = chosen;
  found.off_grid = view == views.begin();
  found.fit = found.off_grid ? fit_off_grid(chosen, data, question.drive)
                             : evaluate_structure(data.records, {},
                                                  fit_again(chosen, (*view)(data.records), question.drive));
  found.losses = linear_held_out_losses(data.records, question.division, found.fit);
  found.description = description_of(chosen.structure);
  name_ingredients(found, better->ablation, search);
  return found;
}

bool has_lower_loss(const BaseFindings& found, const Selection& plain, double noise_mm, bool plain_explains) {
  // If the selection leaves too large an error, none of its causes is named. The components of a base
  // structure can be named even in this case. Therefore a base structure with an only slightly lower loss
  // gives more information.
  const bool says_more = !plain_explains && !plain.extended.causes.empty() && !found.named.empty();
  const bool needs_fewer = plain.left.excess_mm > noise_mm && has_some_of(found, plain);
  const double at_most = needs_fewer ? limits::comparable_ratio
                         : says_more ? 1
                                     : 1 - limits::equal_error_share;
  if (rmse_mm(found.losses) < at_most * rmse_mm(plain.extended_losses)) return true;
  return beta_over_gain(plain.extended.point.model) > 1 &&
         found.fit.mean_square_mm2 < plain.extended.mean_square_mm2;
}

void find_causes_upon(BaseFindings& found, const BaseSearch& search, const CausesUpon& allowed) {
  const auto& [data, plain, question] = search;
  SelectionOptions options;
  options.seed = question.seed;
  options.progress = question.progress;
  options.most_causes = allowed.most;
  options.least_taken = question.drive == Drive::measured ? from_the_measured_pressure : from_the_command;
  StructureTrial base = found.chosen;
  base.structure.hysteresis = HysteresisForm::play;
  base.structure.characteristic = true;
  base.ridge = std::min(base.ridge, most_ridge);
  free_the_base(found, base, search);
  options.base_again = [base, drive = question.drive](const std::vector<Record>& readings) {
    return fit_nearby(base, readings, drive);
  };
  Selection selection = select_among_thinned(found.fit.point, data, question, options);
  if (selection.chosen.empty()) return;
  StructureFit with =
      fit_structure(data.records, selection.extended.causes, selection.extended.point, finishing_effort);
  BlockLosses losses = linear_held_out_losses(data.records, question.division, with);
  drop_what_is_not_missed(with, losses, selection.chosen, data, question);
  const double before = selection.base_unexplained.excess_mm, after = selection.left.excess_mm;
  const bool clear = after * after < (1 - allowed.least_share) * before * before;
  if (!clear && !allowed.parts) return;
  for (NamedCause& cause : name_chosen(data.records, with, selection.chosen)) {
    if (clear || !is_among(found.possible, cause.cause))
      (clear ? found.named : found.possible).push_back(std::move(cause));
  }
  if (!clear) return;
  found.description = description_of(base.structure);
  found.fit = std::move(with);
  found.losses = std::move(losses);
  take_back_confounded(found, data, question);
  take_back_alternatives(found);
  renumber(found, data);
}

}  // namespace softgrip::sysid
