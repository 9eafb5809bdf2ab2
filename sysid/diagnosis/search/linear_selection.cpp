#include "sysid/diagnosis/search/linear_selection.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "sysid/diagnosis/causes/backlash.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/named_claim.h"
#include "sysid/diagnosis/search/scan.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/diagnosis/search/slack.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Largest mean square of a candidate after the linear fit, as a multiple of the smallest mean square of all
/// candidates. A candidate above this limit is dropped, because a refit of the base structure absorbs at most
/// about half of the effect of a cause.
constexpr double hopeless_ratio = 4;
/// Number of rounds of the alternating fit. In each round, the base structure is fitted while the cause is
/// fixed, and then the cause is fitted while the base structure is fixed.
constexpr int turns = 2;
/// Trial shares of the linear response of the base structure to a cause. The fit starts at the share with the
/// smallest error. If the base structure is strongly nonlinear, the full response is too large.
constexpr std::array answers{1.0, 0.5, 0.2, 0.0};
/// Limit of the mean logarithm of the ratio of the block losses (without the cause / with the cause). If the
/// lower end of its 95 % interval is above this limit, the losses count as reduced in most blocks (see
/// LeastTaken).
constexpr double in_most_blocks = 0.15;
/// Largest elastic_share() for which a backlash is searched that the play operators may have absorbed.
constexpr double little_elastic = 0.3;
/// Largest number of alternatives to a named cause. If more candidates fit nearly as well as the best one, no
/// cause is named.
constexpr std::size_t most_undecided = 2;
/// Smallest reduction by a further cause, as a share of the remaining mean square above the noise. If the
/// data contain a second effect, the true cause of this effect removes almost all of the remaining mean
/// square.
constexpr double most_of_the_rest = 0.6;

/// A start point of a fit, and the mean square of its residual.
struct Start {
  FitPoint point;
  double left_mm2 = std::numeric_limits<double>::infinity();
};

Start start_at(const std::vector<Record>& records, FitPoint point) {
  const double left_mm2 = evaluate_structure(records, {}, point).mean_square_mm2;
  return {std::move(point), left_mm2};
}

Start best_answer(const std::vector<Record>& records, const Scan& base, const Cause& cause,
                  const LinearFit& fit) {
  const model::BlockSpec& block = fit.beside.model.blocks[*position_of(fit.beside.model, cause)];
  Start best{fit.beside};
  for (const double share : answers) {
    FitPoint point = base.answer_to(fit.left, share);
    point.model = model::with_block(point.model, block);
    Start one = start_at(records, std::move(point));
    if (one.left_mm2 < best.left_mm2) best = std::move(one);
  }
  return best;
}

class SelectorUpon {
 public:
  SelectorUpon(const SearchData& data, StructureFit base, double noise_mm, const Division& division,
               const SelectionOptions& options)
      : data_(data), noise_mm_(noise_mm), division_(division), options_(options), scales_(data.scales) {
    scales_.residual_lines = spectrum_peaks(data.records, base.residual_mm);
    BlockLosses losses = linear_held_out_losses(data.records, division, base);
    result_ = selection_from(std::move(base), std::move(losses), noise_mm, data.scales.step_mm);
  }

  Selection run() {
    while (result_.left.present && result_.chosen.size() < options_.most_causes && more_can_be_worth() &&
           add_one()) {
    }
    return std::move(result_);
  }

 private:
  /// Returns linear fits of all causes that the structure does not contain, sorted by their mean square
  /// (smallest first). A cause with a free form has two fits: the best fit of a physical law, and the fit of
  /// the free form.
  std::vector<std::pair<Cause, LinearFit>> linear_fits(const Scan& scan) {
    const StructureFit& current = result_.extended;
    if (!scan.usable()) return {};
    std::vector<Cause> causes;
    for (const Cause& cause : all_causes()) {
      if (cause.found_by_fitting && !position_of(current.point.model, cause) &&
          unanswerable(cause, scales_).empty())
        causes.push_back(cause);
    }
    // For each cause: the best fit of a physical law, and the best fit of a free form.
    std::vector<std::array<LinearFit, 2>> best(causes.size());
    std::atomic<std::size_t> tried{0};
    parallel_for(causes.size(), data_.threads, [&](std::size_t i) {
      for (const FitPoint& start : best_starts({&scan, 1}, causes[i], scales_, limits::followed_starts)) {
        LinearFit fit = linear_fit_from(data_.thinned, scan, causes[i], start);
        LinearFit& of_its_kind = best[i][has_free_form(start.model, causes[i]) ? 1 : 0];
        if (fit.mean_square_mm2 < of_its_kind.mean_square_mm2) of_its_kind = std::move(fit);
      }
      if (options_.progress)
        options_.progress("another model structure: tested " + std::to_string(++tried) + " of " +
                          std::to_string(causes.size()));
    });
    std::vector<std::pair<Cause, LinearFit>> list;
    for (std::size_t i = 0; i < causes.size(); ++i) {
      for (LinearFit& fit : best[i]) {
        if (std::isfinite(fit.mean_square_mm2)) list.emplace_back(causes[i], std::move(fit));
      }
    }
    std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
      return a.second.mean_square_mm2 < b.second.mean_square_mm2;
    });
    return list;
  }

  /// Fits the base structure and the last one of `causes` alternately. Each of them is fitted to the readings
  /// minus the effect of the other one. This is necessary because the base structure was fitted without the
  /// cause and has absorbed part of its effect.
  [[nodiscard]] FitPoint settled(Start best, const std::vector<Cause>& causes) const {
    if (!options_.base_again) return best.point;
    const Cause& cause = causes.back();
    const std::vector<Cause> others(causes.begin(), causes.end() - 1);
    for (int turn = 0; turn < turns; ++turn) {
      const model::Model& model = best.point.model;
      FitPoint again = options_.base_again(without_effects(data_.thinned, best.point, causes));
      for (const Cause& one : others)
        again.model = model::with_block(again.model, model.blocks[*position_of(model, one)]);
      const Scan scan(data_.thinned, others, again);
      if (!scan.usable()) break;
      again.model = model::with_block(again.model, model.blocks[*position_of(model, cause)]);
      const LinearFit fit = linear_fit_from(data_.thinned, scan, cause, again);
      Start now = start_at(data_.thinned, std::move(again));
      if (std::isfinite(fit.mean_square_mm2)) {
        Start answered = best_answer(data_.thinned, scan, cause, fit);
        if (answered.left_mm2 < now.left_mm2) now = std::move(answered);
      }
      if (!(now.left_mm2 < best.left_mm2)) break;
      best = std::move(now);
    }
    return best.point;
  }

  /// Fits the structure with `causes` to all readings, starting at `best`, and computes its held-out losses.
  /// The last element of `causes` is the new cause.
  [[nodiscard]] ScoredCandidate finished(Start best, const std::vector<Cause>& causes) const {
    ScoredCandidate one;
    one.candidate.cause = causes.back();
    one.candidate.fit =
        fit_structure(data_.records, causes, settled(std::move(best), causes), finishing_effort);
    one.losses = linear_held_out_losses(data_.records, division_, *one.candidate.fit);
    return one;
  }

  std::vector<ScoredCandidate> score() {
    const Scan scan(data_.thinned, result_.extended.causes, result_.extended.point);
    const std::vector<std::pair<Cause, LinearFit>> found = linear_fits(scan);
    const auto worse = std::find_if(found.begin(), found.end(), [&](const auto& one) {
      return one.second.mean_square_mm2 > hopeless_ratio * found.front().second.mean_square_mm2;
    });
    std::vector<ScoredCandidate> followed(
        std::min(limits::finalists, static_cast<std::size_t>(worse - found.begin())));
    parallel_for(followed.size(), data_.threads, [&](std::size_t i) {
      const auto& [cause, fit] = found[i];
      std::vector<Cause> causes = result_.extended.causes;
      causes.push_back(cause);
      followed[i] = finished(best_answer(data_.thinned, scan, cause, fit), causes);
    });
    std::vector<ScoredCandidate> scored;
    for (ScoredCandidate& one : followed) put_if_better(std::move(one), scored);
    if (auto with_backlash = play_as_backlash()) put_if_better(std::move(*with_backlash), scored);
    std::stable_sort(scored.begin(), scored.end(), [](const ScoredCandidate& a, const ScoredCandidate& b) {
      return rmse_mm(a.losses) < rmse_mm(b.losses);
    });
    return scored;
  }

  /// Returns a fit with a backlash. The fit starts at reduced thresholds of the play operators, because a fit
  /// from the current thresholds would not reach the optimum. Returns nullopt if the play operators cannot
  /// have absorbed a backlash.
  [[nodiscard]] std::optional<ScoredCandidate> play_as_backlash() const {
    const FitPoint& point = result_.extended.point;
    if (elastic_share(point.model) > little_elastic) return std::nullopt;
    const auto model = with_slack_as_backlash(point.model);
    if (!model) return std::nullopt;
    std::vector<Cause> causes = result_.extended.causes;
    causes.push_back(*find_cause(causes::Backlash::id));
    return finished(start_at(data_.thinned, {*model, point.starts}), causes);
  }

  static void put_if_better(ScoredCandidate one, std::vector<ScoredCandidate>& scored) {
    const auto same = std::find_if(scored.begin(), scored.end(), [&](const ScoredCandidate& other) {
      return other.candidate.cause == one.candidate.cause;
    });
    if (same == scored.end()) {
      scored.push_back(std::move(one));
    } else if (rmse_mm(one.losses) < rmse_mm(same->losses)) {
      *same = std::move(one);
    }
  }

  bool add_one() {
    std::vector<ScoredCandidate> scored = score();
    const bool found = best_first(scored);
    result_.last_candidates = describe(scored, result_.extended_losses, options_.seed);
    if (!found) return false;
    const BlockLosses before = result_.extended_losses;
    if (!take(scored)) return false;
    if (result_.chosen.size() > 1) return both_stay(before);
    in_first_place_ = std::move(scored);
    return true;
  }

  bool best_first(std::vector<ScoredCandidate>& scored) const {
    const Division by_unit = divide_by_unit(data_.records);
    return put_nameable_first(
        scored, data_.records, result_.extended,
        [this](const ScoredCandidate& one) {
          return is_gain(result_.extended_losses, one.losses, share_worth_mm2());
        },
        [&](const StructureFit& fit) { return linear_held_out_losses(data_.records, by_unit, fit); },
        options_.seed);
  }

  [[nodiscard]] bool is_gain(const BlockLosses& before, const BlockLosses& after, double worth_mm2) const {
    const Spread gain = mean_difference(before, after, options_.seed);
    const Spread ratio = mean_log_ratio(before, after, options_.seed);
    const LeastTaken& least = options_.least_taken;
    const double noises = ratio.lower > in_most_blocks ? least.in_most_blocks : least.anyhow;
    return gain.value > std::max(worth_mm2, noises * noise_mm_ * noise_mm_) &&
           (gain.lower > 0 || ratio.lower > 0);
  }

  /// Adds the best candidate to the selection and returns true, under two conditions. The candidate must
  /// reduce the error sufficiently, and at most most_undecided other candidates may fit nearly as well.
  bool take(const std::vector<ScoredCandidate>& scored) {
    const ScoredCandidate& best = scored.front();
    ChosenCause chosen =
        weigh(best.candidate.cause,
              {*best.candidate.fit, best.losses, result_.extended_losses, noise_mm_, options_.seed}, scored);
    if (!stands(chosen, scored)) return false;
    result_.extended = *best.candidate.fit;
    result_.extended_losses = best.losses;
    result_.left = unexplained_error_of(result_.extended.residual_mm, noise_mm_, data_.scales.step_mm);
    result_.chosen.push_back(std::move(chosen));
    return true;
  }

  /// Tests if both of two selected causes are needed. The first cause was selected before the second one was
  /// added. Therefore each cause is now fitted alone, starting from the common fit, and compared with the fit
  /// of both causes. A cause that does not reduce the error sufficiently is removed.
  bool both_stay(const BlockLosses& beside_the_first) {
    const Cause first = result_.extended.causes.front(), second = result_.extended.causes.back();
    ScoredCandidate first_alone = alone(first, second);
    const bool better_so = rmse_mm(first_alone.losses) < rmse_mm(beside_the_first);
    const BlockLosses& by_the_first = better_so ? first_alone.losses : beside_the_first;
    if (!is_worth_its_place(by_the_first)) {
      stand_alone(std::move(first_alone));
      return false;
    }
    ScoredCandidate second_alone = alone(second, first);
    if (rmse_mm(second_alone.losses) >= rmse_mm(by_the_first)) return true;
    if (is_worth_its_place(second_alone.losses)) return true;
    stand_alone(std::move(second_alone));
    return false;
  }

  /// Returns true if one of two selected causes reduces the error sufficiently in addition to the other one.
  /// @param before  losses of the structure with only the other cause.
  [[nodiscard]] bool is_worth_its_place(const BlockLosses& before) const {
    return is_gain(before, result_.extended_losses, further_share_mm2(before));
  }

  /// Returns a fit of the structure with `cause` and without `other`. The fit starts at the common fit of
  /// both causes.
  [[nodiscard]] ScoredCandidate alone(const Cause& cause, const Cause& other) const {
    FitPoint rest = result_.extended.point;
    rest.model = without(std::move(rest.model), other);
    return finished(start_at(data_.thinned, std::move(rest)), {cause});
  }

  void stand_alone(ScoredCandidate one) {
    std::erase_if(in_first_place_,
                  [&](const auto& other) { return other.candidate.cause == one.candidate.cause; });
    in_first_place_.insert(in_first_place_.begin(), std::move(one));
    result_.extended = result_.base;
    result_.extended_losses = result_.base_losses;
    result_.left = result_.base_unexplained;
    result_.chosen.clear();
    take(in_first_place_);
  }

  /// Returns the smallest reduction of the mean square that a further cause must achieve [mm^2].
  [[nodiscard]] double share_worth_mm2() const {
    return result_.chosen.empty() ? 0 : further_share_mm2(result_.extended_losses);
  }
  [[nodiscard]] double further_share_mm2(const BlockLosses& before) const {
    return std::max(limits::form_error_share * std::pow(result_.base_unexplained.excess_mm, 2),
                    most_of_the_rest * beyond_noise_mm2(before));
  }

  [[nodiscard]] double beyond_noise_mm2(const BlockLosses& losses) const {
    return std::pow(rmse_mm(losses), 2) - noise_mm_ * noise_mm_;
  }

  /// Returns true if the remaining error is large enough that a further cause can achieve the required
  /// reduction.
  [[nodiscard]] bool more_can_be_worth() const {
    const double least_mm2 = options_.least_taken.in_most_blocks * noise_mm_ * noise_mm_;
    return beyond_noise_mm2(result_.extended_losses) > std::max(least_mm2, share_worth_mm2());
  }

  /// Returns true if the candidate can be named. Its loss must be significantly lower than without it. Every
  /// other candidate that fits nearly as well becomes its alternative, unless it is a free form. If there are
  /// more than most_undecided alternatives, no cause is named and the result is false.
  [[nodiscard]] bool stands(ChosenCause& chosen, const std::vector<ScoredCandidate>& scored) const {
    const ScoredCandidate& best = scored.front();
    const auto beats = [&](const BlockLosses& losses) {
      return winning_share(best.losses, losses, options_.seed) >= limits::probability ||
             mean_log_ratio(losses, best.losses, options_.seed).lower > limits::form_error_share;
    };
    if (!beats(result_.extended_losses)) return false;
    std::size_t undecided = 0;
    for (const ScoredCandidate& other : scored) {
      const Cause& cause = other.candidate.cause;
      if (cause == chosen.cause || is_free_form(other) || beats(other.losses)) continue;
      ++undecided;
      if (std::find(chosen.alternatives.begin(), chosen.alternatives.end(), cause) ==
          chosen.alternatives.end())
        chosen.alternatives.push_back(cause);
    }
    return undecided <= most_undecided;
  }

  const SearchData& data_;
  double noise_mm_;
  const Division& division_;
  const SelectionOptions& options_;
  Scales scales_;
  Selection result_;
  std::vector<ScoredCandidate> in_first_place_;  ///< candidates that were tested when the first cause was
                                                 ///< selected
};

}  // namespace

Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                             const Division& division, const SelectionOptions& options) {
  return SelectorUpon(data, std::move(base), noise_mm, division, options).run();
}

}  // namespace softgrip::sysid
