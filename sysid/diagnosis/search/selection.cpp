#include "sysid/diagnosis/search/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/causes/twins.h"

namespace softgrip::sysid {
namespace {

/// Candidates that are refitted without held-out blocks.
constexpr std::size_t finalists = 4;
/// What one more cause must take of the recalibrated model's excess, as a mean square. Less makes up for the
/// form of an equation that the first cause does not quite have: a finger that softens, ages or bends by
/// another law than the catalogue's leaves up to some percent, and any second block takes part of that.
constexpr double one_more_share = 0.05;
/// A smaller effect must take at least so much, and leave no more than so much of what was left before it:
/// what makes up for a form does not meet it whole.
constexpr double small_share = 0.01;
constexpr double left_by_a_small_one = 0.1;
/// A candidate whose excess over the best, in mean square, is larger than this share of what the best gained
/// is no rival whatever the blocks say.
constexpr double rival_share = 0.05;

double square(double x) {
  return x * x;
}

class Selector {
 public:
  Selector(const SearchData& data, StructureFit base, double noise_mm, const Division& division,
           const SelectionOptions& options)
      : data_(data), noise_(noise_mm), division_(division), options_(options) {
    result_.base = std::move(base);
    result_.base_losses = held_out_losses(data_.records, division_, result_.base);
    result_.base_structure = structure_of(result_.base.residual_mm, noise_);
    result_.extended = result_.base;
    result_.extended_losses = result_.base_losses;
    result_.left = result_.base_structure;
  }

  Selection run() {
    while (result_.left.present && result_.extended.causes.size() < options_.most_causes) {
      if (!add_one()) break;
      if (result_.extended.causes.size() > 1) swap_others();
    }
    while (result_.extended.causes.size() > 1 && drop_idle_one()) {
    }
    for (std::size_t i = 0; i < result_.extended.causes.size(); ++i) explain(i);
    return std::move(result_);
  }

 private:
  struct Scored {
    Candidate candidate;
    BlockLosses losses;  ///< empty: not refitted
  };

  /// A form that can follow anything slow is named only where no law explains nearly as much, and is no rival
  /// of one that does.
  static bool is_free_form(const Scored& s) {
    const model::Model& model = s.candidate.fit->point.model;
    return form_of(s.candidate.cause, model.blocks[*position_of(model, s.candidate.cause)]).free_form;
  }

  /// All candidates for one more cause on top of `current`, fitted, the best ones scored held out; best
  /// first.
  std::vector<Scored> score(const StructureFit& current) {
    std::vector<Candidate> candidates = fit_candidates(data_, current, {}, [&](const Cause& cause) {
      if (options_.progress) options_.progress("tried " + std::string(cause.id));
    });
    std::vector<Scored> scored;
    scored.reserve(candidates.size());
    for (Candidate& candidate : candidates) scored.push_back({std::move(candidate), {}});
    const auto fitted = [](const Scored& s) {
      return s.candidate.fit ? s.candidate.fit->mean_square_mm2 : std::numeric_limits<double>::infinity();
    };
    std::stable_sort(scored.begin(), scored.end(),
                     [&](const Scored& a, const Scored& b) { return fitted(a) < fitted(b); });
    const std::size_t count = std::min(finalists, scored.size());
    parallel_for(count, data_.threads, [&](std::size_t i) {
      if (!scored[i].candidate.fit) return;
      scored[i].losses = held_out_losses(data_.records, division_, *scored[i].candidate.fit);
    });
    const double handicap = one_more_share * mean_square_excess(current);
    const auto held_out = [&](const Scored& s) {
      if (s.losses.empty()) return std::numeric_limits<double>::infinity();
      return square(rmse_mm(s.losses)) + (is_free_form(s) ? handicap : 0);
    };
    std::stable_sort(scored.begin(), scored.begin() + static_cast<long>(count),
                     [&](const Scored& a, const Scored& b) { return held_out(a) < held_out(b); });
    return scored;
  }

  /// A gain whose interval excludes nothing and whose size is worth having. `without` and `with` are the
  /// structures that it lies between.
  [[nodiscard]] bool is_gain(const BlockLosses& before, const BlockLosses& after, const StructureFit& without,
                             const StructureFit& with) const {
    const Spread difference = mean_difference(before, after, options_.seed);
    double worth = 0.01 * noise_ * noise_;
    if (!without.causes.empty()) {
      const double was = mean_square_excess(without), left = mean_square_excess(with);
      const double share = left > left_by_a_small_one * was ? one_more_share : small_share;
      worth = std::max(worth, share * square(result_.base_structure.excess_mm));
    }
    return difference.lower > 0 && difference.value > worth &&
           difference.value > 0.02 * rmse_mm(before) * rmse_mm(before) * 0.5;
  }

  [[nodiscard]] double mean_square_excess(const StructureFit& fit) const {
    return square(structure_of(fit.residual_mm, noise_).excess_mm);
  }

  bool add_one() {
    std::vector<Scored> scored = score(result_.extended);
    if (scored.empty() || scored.front().losses.empty() ||
        !is_gain(result_.extended_losses, scored.front().losses, result_.extended,
                 *scored.front().candidate.fit)) {
      result_.last_candidates = describe(scored, result_.extended_losses);
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
    result_.left = structure_of(result_.extended.residual_mm, noise_);
    fresh_.clear();
    without_.clear();
  }

  /// The structure without one of its causes. It is refitted, and judged, once for as long as the structure
  /// stands.
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

  /// Looks whether another cause serves better in an earlier one's place, now that one more is there.
  void swap_others() {
    for (std::size_t i = 0; i + 1 < result_.extended.causes.size(); ++i) {
      const Cause old = result_.extended.causes[i];
      std::vector<Scored> scored = score(without(i));
      if (scored.empty() || scored.front().losses.empty()) continue;
      const bool better = rmse_mm(scored.front().losses) < rmse_mm(result_.extended_losses) &&
                          scored.front().candidate.cause != old;
      if (better) {
        take(scored.front());
        return;  // the new one stands last now; the others were searched with the old
      }
      fresh_[i] = std::move(scored);
    }
  }

  /// What was added beside a cause that was then replaced may have nothing left to do.
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

  void explain(std::size_t index) {
    ChosenCause chosen;
    chosen.cause = result_.extended.causes[index];
    std::vector<Scored> scored;
    const auto fresh = fresh_.find(index);
    if (fresh != fresh_.end()) {
      scored = std::move(fresh->second);
    } else {
      scored = score(without(index));
    }
    const BlockLosses& rest_losses = losses_without(index);
    chosen.gain_percent = gain_percent(rest_losses, result_.extended_losses, options_.seed);
    const double gained = square(rmse_mm(rest_losses)) - square(rmse_mm(result_.extended_losses));
    chosen.gain_mm2 = mean_difference(rest_losses, result_.extended_losses, options_.seed);
    chosen.inclusion = winning_share(result_.extended_losses, rest_losses, options_.seed);
    const auto twin = twin_of(chosen.cause, result_.extended.point.model);
    if (twin) chosen.rivals.push_back(*twin);
    for (const Scored& s : scored) {
      if (s.losses.empty() || s.candidate.cause == chosen.cause) continue;
      if (twin && s.candidate.cause == *twin) continue;
      if (is_free_form(s)) continue;
      chosen.inclusion =
          std::min(chosen.inclusion, winning_share(result_.extended_losses, s.losses, options_.seed));
      const Spread behind = mean_difference(s.losses, result_.extended_losses, options_.seed);
      // How far an object gives way tells it from a sensor that clips, and of a hard one a few readings say
      // little.
      const bool stops = s.candidate.cause.is_stop && chosen.cause.is_stop;
      const double negligible = (stops ? 0.02 : 0.002) * noise_ * noise_;
      if (behind.value <= std::max(behind.standard_error, negligible) &&
          behind.value <= std::max(rival_share * gained, negligible)) {
        chosen.rivals.push_back(s.candidate.cause);
      }
    }
    if (twin) chosen.inclusion /= 2;
    chosen.candidates = describe(scored, rest_losses);
    result_.chosen.push_back(std::move(chosen));
  }

  [[nodiscard]] std::vector<CandidateScore> describe(const std::vector<Scored>& scored,
                                                     const BlockLosses& before) const {
    std::vector<CandidateScore> list;
    for (const Scored& s : scored) {
      CandidateScore one{
          s.candidate.cause, s.candidate.why_not, 0, std::numeric_limits<double>::quiet_NaN(), {}};
      if (s.candidate.fit) one.rmse_mm = std::sqrt(s.candidate.fit->mean_square_mm2);
      if (!s.losses.empty()) {
        one.heldout_rmse_mm = rmse_mm(s.losses);
        one.gain_percent = gain_percent(before, s.losses, options_.seed);
      }
      list.push_back(std::move(one));
    }
    return list;
  }

  const SearchData& data_;
  double noise_;
  const Division& division_;
  const SelectionOptions& options_;
  Selection result_;
  /// The structure without one cause: its fit, and what it loses held out, as far as they were asked for.
  struct Without {
    std::optional<StructureFit> fit;
    std::optional<BlockLosses> losses;
  };
  std::map<std::size_t, std::vector<Scored>> fresh_;  ///< searches that still hold, by place
  std::map<std::size_t, Without> without_;            ///< by place
};

}  // namespace

Selection select_causes(const SearchData& data, StructureFit base, double noise_mm, const Division& division,
                        const SelectionOptions& options) {
  return Selector(data, std::move(base), noise_mm, division, options).run();
}

}  // namespace softgrip::sysid
