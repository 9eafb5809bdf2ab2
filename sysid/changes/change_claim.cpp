#include "sysid/changes/change_claim.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "base/statistics.h"
#include "sysid/changes/bins.h"
#include "sysid/changes/change_size.h"
#include "sysid/changes/filter_fit.h"
#include "sysid/evidence/units.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Returns true if the effect increases the prediction error of left-out later runs. The effect is fitted to
/// all runs except one and then predicts this run. A run in which the effect does not occur has no influence
/// on the result, because its two errors are equal. For example, a run may not reach the saturation of a
/// sensor. The result is false for a free-form effect.
bool predicts_worse(const CauseSearch& search, const Effect& effect) {
  PairedLosses losses;
  if (effect.free_form) return false;
  const LaterReadings& readings = search.readings;
  const Units units(readings.records());
  for (std::size_t unit = 0; unit < units.count(); ++unit) {
    const LaterReadings rest = readings.without(units, unit), own = readings.only(units, unit);
    if (rest.records().empty() || own.records().empty()) continue;
    const EffectFit fit = fit_effect(rest, effect, search.found, rest.white(search.found));
    losses.append(losses_of(minus(own.left(), own.added(search.with(fit.fitted))),
                            minus(own.left(), own.added(search.found)), Units(own.records()),
                            readings.base().bin_s));
  }
  return is_better(compare(losses, 0, search.seed));
}

/// Returns the residuals with these effects at each whitened row, without whitening. The mean of each record
/// is subtracted.
Eigen::VectorXd residuals_with(const LaterReadings& readings, const std::vector<FittedEffect>& effects) {
  const Binned left = minus(readings.left(), readings.added(effects));
  std::vector<double> sums(left.size()), counts(left.size());
  const std::vector<WhiteRows::Row>& rows = readings.rows().rows();
  for (const auto& [r, b, spread] : rows) {
    sums[r] += left[r][b];
    counts[r] += 1;
  }
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(rows.size()));
  Eigen::Index next = 0;
  for (const auto& [r, b, spread] : rows) residuals(next++) = left[r][b] - sums[r] / counts[r];
  return residuals;
}

/// Returns true if the effect changes the required rows by more than the penalty for its parameters. A
/// smaller effect can neither be confirmed nor be refuted there. For example, the only rest may be at the
/// start of the log, where a drift has not begun.
bool is_visible(const CauseSearch& search, const ScoredEffect& scored, const std::vector<bool>& required) {
  double sum = 0;
  for (std::size_t i = 0; i < required.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (required[i]) sum += square(scored.fit.white(row) - search.without(row));
  }
  return sum > price_of(scored.fit.fitted.effect);
}

/// Returns true if the effect reduces the error at the required rows, with or without whitening. Whitening
/// removes slow errors, so that the rows of a short rest do not show a slow drift.
bool is_shown(const CauseSearch& search, const ScoredEffect& scored, const std::vector<bool>& required) {
  const auto reduces = [&](const Eigen::VectorXd& worse, const Eigen::VectorXd& better) {
    return is_better(compare(paired_losses(search.readings, worse, better, &required), 0, search.seed));
  };
  return reduces(search.without, scored.fit.white) ||
         reduces(residuals_with(search.readings, search.found),
                 residuals_with(search.readings, search.with(scored.fit.fitted)));
}

/// Returns the share of the remaining error that the effect explains. It is the larger one of two shares: of
/// the mean square error of the readings, and of the excess of the whitened mean square over 1, its value in
/// the healthy logs. Whitening removes slow errors, so the second share does not show a slow effect.
double explained_share(const CauseSearch& search, const ScoredEffect& scored, const Claim& claim) {
  const double excess = per_bin(search.readings, search.without) - 1;
  return std::max(1 - square(claim.error_with / claim.error_without), excess > 0 ? scored.gain / excess : 0);
}

/// Returns true if an effect with more parameters has the same influence on the readings as the best effect,
/// because the best effect is a special case of it. For example, a contact near the rest position is a
/// smaller gain.
bool only_imitates(const CauseSearch& search, const ScoredEffect& best, const ScoredEffect& other) {
  const auto numbers = [](const ScoredEffect& scored) { return scored.fit.fitted.effect.numbers.size(); };
  return numbers(other) > numbers(best) && other.gain <= best.gain &&
         (other.fit.white - best.fit.white).squaredNorm() <
             limits::form_error_share * (best.fit.white - search.without).squaredNorm();
}

std::optional<Interval> distance_from_neutral(const ShownSize& shown) {
  if (!shown.interval) return std::nullopt;
  return Interval{shown.interval->lower - shown.neutral, shown.interval->upper - shown.neutral};
}

/// Adds the size of the effect to the claim. The intervals are those that the answer states if the effect is
/// the last one that is found.
void add_sizes(Claim& claim, const CauseSearch& search, const FittedEffect& fitted) {
  const LaterReadings& readings = search.readings;
  const Base& base = readings.base();
  const CampaignSize range{base.largest_kpa, base.span_mm, campaign_size(readings.records()).longest_s};
  const double deviation = readings.nuisance(search.with(fitted)).gain;
  const std::vector<FittedEffect> all = search.with(with_whole_gain(readings, fitted, deviation));
  const std::vector<EffectIntervals> intervals = intervals_of(readings, all, search.healthy, search.left_out);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ShownSize shown = shown_size(readings, all[i], intervals[i]);
    const std::optional<Interval> size = distance_from_neutral(shown);
    if (i < search.found.size()) {
      claim.keeps_other_sizes = claim.keeps_other_sizes && (!size || excludes(*size, 0));
      continue;
    }
    claim.size = size;
    claim.largest_size = largest_possible_size(range, shown.size.unit, shown.neutral);
  }
}

}  // namespace

std::vector<FittedEffect> CauseSearch::with(const FittedEffect& one) const {
  std::vector<FittedEffect> all = found;
  all.push_back(one);
  return all;
}

std::vector<bool> required_rows(const LaterReadings& readings, Appears appears) {
  const double bin_s = readings.base().bin_s;
  Binned drive, rate;
  for (std::size_t r = 0; r < readings.records().size(); ++r) {
    const Record& record = readings.records()[r];
    const std::size_t bins = readings.left()[r].size();
    drive.push_back(with_bins(binned(record, record.drive_kpa, bin_s), bins));
    rate.push_back(with_bins(peak_rate_of(record, bin_s), bins));
  }
  std::vector<OperatingPoint> conditions;
  for (const auto& [r, b, spread] : readings.rows().rows())
    conditions.push_back({drive[r][b], rate[r][b], readings.plain()[r][b]});
  return required_at(appears, conditions);
}

Veto vetoed(const CauseSearch& search, const ScoredEffect& scored) {
  const LaterReadings& readings = search.readings;
  const FittedEffect& fitted = scored.fit.fitted;
  const std::vector<bool> required = required_rows(readings, fitted.effect.appears);
  Claim claim;
  claim.condition_met = is_met(required) && is_visible(search, scored, required);
  if (!claim.condition_met) return veto_of(claim);
  const std::vector<FittedEffect> all = search.with(fitted);
  add_sizes(claim, search, fitted);
  claim.error_without = readings.plain_rms(search.found);
  claim.error_with = readings.plain_rms(all);
  claim.explained_share = explained_share(search, scored, claim);
  claim.predicts_worse = predicts_worse(search, fitted.effect);
  claim.shown_there = is_shown(search, scored, required);
  return veto_of(claim);
}

bool is_alternative(const CauseSearch& search, const ScoredEffect& best, const ScoredEffect& other,
                    const Ties& ties) {
  if (other.fit.fitted.effect.id == best.fit.fitted.effect.indistinguishable) return true;
  if (other.gain < limits::majority_share * best.gain || only_imitates(search, best, other)) return false;
  return ties(best, other) || other.gain >= (1 - limits::equal_error_share) * best.gain ||
         !search.spread.admits_a_change(search.readings.plain_rms(search.with(other.fit.fitted)),
                                        per_bin(search.readings, other.fit.white));
}

}  // namespace softgrip::sysid
