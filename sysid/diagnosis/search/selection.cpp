#include "sysid/diagnosis/search/selection.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/diagnosis/search/named_claim.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Mean square below which a residual counts as explained, as a multiple of the squared noise.
constexpr double near_the_noise = 2;

class Selector {
 public:
  Selector(const SearchData& data, StructureFit base, double noise_mm, const Division& division,
           const SelectionOptions& options)
      : data_(data),
        noise_(noise_mm),
        division_(division),
        options_(options),
        by_unit_(divide_by_unit(data.records)) {
    BlockLosses losses = held_out_losses(data_.records, division_, base);
    result_ = selection_from(std::move(base), std::move(losses), noise_, data.scales.step_mm);
  }

  Selection run() {
    while (result_.left.present && result_.extended.causes.size() < options_.most_causes) {
      if (result_.extended.causes.size() == 1 && options_.one_cause_stands)
        options_.one_cause_stands(result_);
      if (!add_one()) break;
      if (result_.extended.causes.size() > 1) swap_others();
    }
    while (result_.extended.causes.size() > 1 && drop_idle_one()) {
    }
    while (add_confounded()) {
    }
    for (std::size_t i = 0; i < result_.extended.causes.size(); ++i) explain(i);
    return std::move(result_);
  }

 private:
  using Scored = ScoredCandidate;

  /// Fits all candidates for an additional cause of `current`, and computes the held-out losses of the best
  /// candidates. Returns all candidates, the best one first.
  std::vector<Scored> score(const StructureFit& current) {
    CandidateSearch search;
    if (!result_.extended.causes.empty() && options_.to_beat_mm2)
      search.is_hopeless = [this](double best_mm2) { return is_far_behind(best_mm2); };
    if (options_.progress) {
      search.progress = [&](std::size_t tried, std::size_t of) {
        const std::string number = "cause number " + std::to_string(current.causes.size() + 1);
        options_.progress(tried < of
                              ? number + ": tried " + std::to_string(tried) + " of " + std::to_string(of)
                              : number + ": full fits of the best candidates");
      };
    }
    std::vector<Candidate> candidates = fit_candidates(data_, current, search);
    std::vector<Scored> scored;
    scored.reserve(candidates.size());
    for (Candidate& candidate : candidates) scored.push_back({std::move(candidate), {}});
    const auto fitted = [](const Scored& s) {
      return s.candidate.fit ? s.candidate.fit->mean_square_mm2 : std::numeric_limits<double>::infinity();
    };
    std::stable_sort(scored.begin(), scored.end(),
                     [&](const Scored& a, const Scored& b) { return fitted(a) < fitted(b); });
    const std::size_t count = std::min(finished_candidates, scored.size());
    parallel_for(count, data_.threads, [&](std::size_t i) {
      if (!scored[i].candidate.fit) return;
      scored[i].losses = held_out_losses(data_.records, division_, *scored[i].candidate.fit);
    });
    const double handicap = limits::form_error_share * mean_square_excess(current);
    const auto held_out = [&](const Scored& s) {
      if (s.losses.empty()) return std::numeric_limits<double>::infinity();
      return square(rmse_mm(s.losses)) + (is_free_form(s) ? handicap : 0);
    };
    std::stable_sort(scored.begin(), scored.begin() + static_cast<long>(count),
                     [&](const Scored& a, const Scored& b) { return held_out(a) < held_out(b); });
    return scored;
  }

  /// Returns true if the best further cause leaves a much larger mean square than another explanation of the
  /// data. Returns false without this comparison if the best further cause reduces the error nearly to the
  /// noise.
  bool is_far_behind(double best_mm2) {
    if (best_mm2 <= near_the_noise * square(noise_)) return false;
    if (!to_beat_mm2_) to_beat_mm2_ = options_.to_beat_mm2();
    return best_mm2 > limits::comparable_ratio * *to_beat_mm2_;
  }

  /// Returns true if the reduction of the losses from `before` to `after` is significant and large enough. A
  /// further cause must remove 5 % of the unexplained mean square of the base structure. If it removes 90 %
  /// of the mean square that is unexplained without it, 1 % is sufficient. A cause that only compensates for
  /// the inexact equation of another cause removes less than that.
  /// @param without  structure with the losses `before`.
  /// @param with  structure with the losses `after`.
  [[nodiscard]] bool is_gain(const BlockLosses& before, const BlockLosses& after, const StructureFit& without,
                             const StructureFit& with) const {
    const Spread difference = mean_difference(before, after, options_.seed);
    double worth = limits::negligible_share * square(noise_);
    if (!without.causes.empty()) {
      const double was = mean_square_excess(without), left = mean_square_excess(with);
      const double share =
          left > limits::equal_error_share * was ? limits::form_error_share : limits::negligible_share;
      worth = std::max(worth, share * square(result_.base_unexplained.excess_mm));
    }
    return difference.lower > 0 && difference.value > worth &&
           difference.value > limits::negligible_share * square(rmse_mm(before));
  }

  [[nodiscard]] double mean_square_excess(const StructureFit& fit) const {
    return square(unexplained_error_of(fit.residual_mm, noise_, data_.scales.step_mm).excess_mm);
  }

  [[nodiscard]] BlockLosses left_out(const StructureFit& fit) const {
    return left_out_losses(data_.records, by_unit_, fit);
  }

  bool best_first(std::vector<Scored>& scored) const {
    return put_nameable_first(
        scored, data_.records, result_.extended,
        [this](const Scored& one) {
          return !one.losses.empty() &&
                 is_gain(result_.extended_losses, one.losses, result_.extended, *one.candidate.fit);
        },
        [this](const StructureFit& fit) { return left_out(fit); }, options_.seed);
  }

  bool add_one() {
    std::vector<Scored> scored = score(result_.extended);
    if (!best_first(scored)) {
      result_.last_candidates = describe(scored, result_.extended_losses, options_.seed);
      return false;
    }
    take(scored.front());
    fresh_[result_.extended.causes.size() - 1] = std::move(scored);
    return true;
  }

  void take(const Scored& best) { stand(*best.candidate.fit, best.losses); }

  void stand(StructureFit fit, BlockLosses losses) {
    result_.extended = std::move(fit);
    result_.extended_losses = std::move(losses);
    result_.left = unexplained_error_of(result_.extended.residual_mm, noise_, data_.scales.step_mm);
    fresh_.clear();
    without_.clear();
  }

  /// Returns the structure after one of its causes is removed and the rest is refitted. The refit is made
  /// once and then stored.
  const StructureFit& without(std::size_t index) {
    if (result_.extended.causes.size() == 1) return result_.base;
    std::optional<StructureFit>& fit = without_[index].fit;
    if (!fit) fit = fit_without_cause(data_.records, result_.extended, result_.extended.causes[index]);
    return *fit;
  }

  const BlockLosses& losses_without(std::size_t index) {
    if (result_.extended.causes.size() == 1) return result_.base_losses;
    const StructureFit& fit = without(index);
    std::optional<BlockLosses>& losses = without_[index].losses;
    if (!losses) losses = held_out_losses(data_.records, division_, fit);
    return *losses;
  }

  /// Compares each earlier cause with all other causes. This is necessary because a further cause was added
  /// after the selection of the earlier one. If another cause predicts better and passes veto_of(), it
  /// replaces the earlier cause, and the comparison ends.
  void swap_others() {
    for (std::size_t i = 0; i + 1 < result_.extended.causes.size(); ++i) {
      const Cause old = result_.extended.causes[i];
      std::vector<Scored> scored = score(without(i));
      if (scored.empty() || scored.front().losses.empty()) continue;
      Candidate& best = scored.front().candidate;
      const bool better =
          rmse_mm(scored.front().losses) < rmse_mm(result_.extended_losses) && best.cause != old;
      const Veto veto = better ? veto_of(
                                     data_.records, best.cause, *best.fit, without(i),
                                     [this](const StructureFit& fit) { return left_out(fit); }, options_.seed)
                               : Veto::none;
      best.why_not = reason_of(veto);
      if (better && veto == Veto::none) {
        take(scored.front());
        // The new cause is the last one in the list. The stored results of all other causes are invalid now,
        // because they were computed with the replaced cause.
        fresh_[result_.extended.causes.size() - 1] = std::move(scored);
        return;
      }
      fresh_[i] = std::move(scored);
    }
  }

  /// Removes the cause with the smallest effect if this effect is not significant, for example because
  /// another cause was replaced. Returns true if a cause was removed.
  bool drop_idle_one() {
    std::size_t least = 0;
    for (std::size_t i = 1; i < result_.extended.causes.size(); ++i) {
      if (rmse_mm(losses_without(i)) < rmse_mm(losses_without(least))) least = i;
    }
    if (is_gain(losses_without(least), result_.extended_losses, without(least), result_.extended))
      return false;
    stand(without(least), losses_without(least));
    return true;
  }

  /// Adds a confounded cause if it reduces the loss significantly. A small reduction is sufficient: if a
  /// confounded cause is missing, the parameter of the selected cause is wrong, but the error increases only
  /// slightly. Returns true if a cause was added.
  bool add_confounded() {
    result_.undecided = fit_confounded(data_, result_.extended, division_);
    for (Confounded& one : result_.undecided) {
      if (!is_missed(result_.extended_losses, one.losses, limits::negligible_share * square(noise_),
                     options_.seed))
        continue;
      stand(std::move(one.fit), std::move(one.losses));
      return true;
    }
    return false;
  }

  void explain(std::size_t index) {
    std::vector<Scored> scored;
    const auto fresh = fresh_.find(index);
    if (fresh != fresh_.end()) {
      scored = std::move(fresh->second);
    } else {
      scored = score(without(index));
    }
    const BlockLosses& rest_losses = losses_without(index);
    result_.chosen.push_back(
        weigh(result_.extended.causes[index],
              {result_.extended, result_.extended_losses, rest_losses, noise_, options_.seed}, scored));
  }

  const SearchData& data_;
  double noise_;
  const Division& division_;
  const SelectionOptions& options_;
  Division by_unit_;
  Selection result_;
  /// result of options_.to_beat_mm2(); not set: the function was not called
  std::optional<double> to_beat_mm2_;
  /// Results for the structure without one of its causes: the fit, and the losses on held-out blocks. Each
  /// result is computed at the first call that needs it.
  struct Without {
    std::optional<StructureFit> fit;
    std::optional<BlockLosses> losses;
  };
  /// Candidates that were tested in place of a cause. Key: index of the cause. Results that are no longer
  /// valid are removed.
  std::map<std::size_t, std::vector<Scored>> fresh_;
  /// Results for the structure without one of its causes. Key: index of the removed cause.
  std::map<std::size_t, Without> without_;
};

}  // namespace

ChosenCause chosen_cause(const Cause& cause, const BlockLosses& without, const BlockLosses& with,
                         std::uint64_t seed) {
  return {cause,
          gain_percent(without, with, seed),
          mean_difference(without, with, seed),
          winning_share(with, without, seed),
          {},
          {}};
}

Selection selection_from(StructureFit base, BlockLosses losses, double noise_mm, double step_mm) {
  Selection selection;
  selection.base_unexplained = selection.left = unexplained_error_of(base.residual_mm, noise_mm, step_mm);
  selection.extended_losses = selection.base_losses = std::move(losses);
  selection.extended = selection.base = std::move(base);
  return selection;
}

Selection select_causes(const SearchData& data, StructureFit base, double noise_mm, const Division& division,
                        const SelectionOptions& options) {
  return Selector(data, std::move(base), noise_mm, division, options).run();
}

}  // namespace softgrip::sysid
