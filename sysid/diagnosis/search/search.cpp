#include "sysid/diagnosis/search/search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "base/statistics.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/search/scan.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

/// `coarse_fit`: effort of the fits from all start points. `look`: effort of a medium fit. It continues a
/// coarse fit that may become the best candidate or an alternative.
constexpr FitEffort coarse_fit{.most_iterations = 8, .tolerance = 1e-5};
constexpr FitEffort look{.most_iterations = 12, .tolerance = 1e-5};
/// Number of causes that always get a medium fit. A further cause gets a medium fit if its mean square after
/// the coarse fit is below worth_a_look times the smallest one.
constexpr std::size_t always_looked_at = 7;
constexpr double worth_a_look = 1.5;
/// Limits that select the candidates for the more precise fits. `near_enough`: candidates after the best
/// limits::finalists also get a full fit to thinned records if their mean square is below this multiple of
/// the smallest one. `next_to_best`: candidates after the best finished_candidates also get a full fit to all
/// samples if their mean square is below this multiple of the smallest one.
/// Near the noise, the mean squares of all candidates are similar. In addition to each of these three limits,
/// a candidate must therefore explain the larger part of what the best candidate explains
/// (limits::majority_share).
constexpr double near_enough = 1.4;
constexpr double next_to_best = 1.05;

/// Returns true if the predictions of two fits of a structure differ by less than a negligible share of the
/// error. The fits then have reached the same minimum from different start points.
bool are_equal(const StructureFit& a, const StructureFit& b) {
  double sum_mm2 = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < a.residual_mm.size(); ++k) {
    for (std::size_t i = 0; i < a.residual_mm[k].size(); ++i) {
      const double difference_mm = a.residual_mm[k][i] - b.residual_mm[k][i];
      if (std::isnan(difference_mm)) continue;
      sum_mm2 += square(difference_mm);
      ++count;
    }
  }
  return sum_mm2 <= square(limits::negligible_share) * static_cast<double>(count) * a.mean_square_mm2;
}

/// Sorts the fits by their mean square. Keeps the best `count` fits, and of equal fits only the best one.
void sort_and_keep(std::vector<StructureFit>& fits, std::size_t count) {
  std::erase_if(fits, [](const StructureFit& fit) { return !std::isfinite(fit.mean_square_mm2); });
  std::stable_sort(fits.begin(), fits.end(), [](const StructureFit& a, const StructureFit& b) {
    return a.mean_square_mm2 < b.mean_square_mm2;
  });
  std::vector<StructureFit> kept;
  for (StructureFit& fit : fits) {
    if (kept.size() < count &&
        std::ranges::none_of(kept, [&](const StructureFit& better) { return are_equal(better, fit); }))
      kept.push_back(std::move(fit));
  }
  fits = std::move(kept);
}

/// Returns one scan for each point at which the search for a further cause may start.
std::vector<Scan> places(const SearchData& data, const StructureFit& current) {
  std::vector<Scan> scans;
  scans.emplace_back(data.glimpsed, current.causes, current.point);
  // The search starts at the given model too. The refit may have absorbed the effect of the cause, so the
  // parameters of the refitted model may be far from the true ones.
  if (current.causes.empty()) scans.emplace_back(data.glimpsed, current.causes, data.given);
  return scans;
}

/// Returns the coarse fits of one candidate to strongly thinned records. The best fit comes first.
std::vector<StructureFit> coarse_fits(const SearchData& data, const StructureFit& current,
                                      std::span<const Scan> scans, const Cause& cause) {
  std::vector<Cause> causes = current.causes;
  causes.push_back(cause);
  std::vector<StructureFit> fits;
  for (const FitPoint& start : best_starts(scans, cause, data.scales, limits::followed_starts)) {
    fits.push_back(fit_structure(data.glimpsed, causes, start, coarse_fit));
  }
  sort_and_keep(fits, fits.size());
  return fits;
}

/// Continues each coarse fit by a medium fit and returns the best medium fits.
std::vector<StructureFit> looks(const SearchData& data, const std::vector<StructureFit>& from) {
  std::vector<StructureFit> fits;
  fits.reserve(from.size());
  for (const StructureFit& fit : from)
    fits.push_back(fit_structure(data.thinned, fit.causes, fit.point, look));
  sort_and_keep(fits, limits::followed_starts);
  return fits;
}

/// Returns true if the last cause of the fit has a free form.
bool is_free(const StructureFit& fit) {
  return has_free_form(fit.point.model, fit.causes.back());
}

/// Returns true if `fit` is better than `best`. With equally many parameters, the fit with the smaller mean
/// square is better. Otherwise, the fit with more parameters is better only if its mean square is smaller by
/// at least the share limits::least_refinement_share. A free form can follow any slow signal. It is better
/// than a physical form of the same cause only if its mean square is smaller by limits::equal_error_share.
bool is_better(const StructureFit& fit, const StructureFit& best) {
  const bool free = is_free(fit), other_kind = free != is_free(best);
  const double ratio = 1 - (other_kind ? limits::equal_error_share : limits::least_refinement_share);
  const bool is_larger = other_kind ? free : fit.free_parameters > best.free_parameters;
  const bool is_smaller = other_kind ? !free : fit.free_parameters < best.free_parameters;
  return fit.mean_square_mm2 < (is_larger ? ratio : is_smaller ? 1 / ratio : 1) * best.mean_square_mm2;
}

StructureFit follow(const SearchData& data, const std::vector<StructureFit>& from) {
  StructureFit best = fit_structure(data.thinned, from[0].causes, from[0].point);
  for (std::size_t i = 1; i < from.size(); ++i) {
    if (from[i].mean_square_mm2 > 1.3 * from[0].mean_square_mm2) break;
    StructureFit fit = fit_structure(data.thinned, from[i].causes, from[i].point);
    if (is_better(fit, best)) best = std::move(fit);
  }
  return best;
}

/// Fits the candidates for an additional cause in stages of increasing effort. Each stage leaves out the
/// candidates that are much worse than the best candidate after the previous stage.
class CandidateFitter {
 public:
  CandidateFitter(const SearchData& data, const StructureFit& current, const CandidateSearch& search)
      : data_(data),
        current_(current),
        search_(search),
        candidates_(wanted()),
        fits_(candidates_.size()),
        explained_mm2_(candidates_.size()) {}

  std::vector<Candidate> run() {
    glance_at_all();
    if (ranking().empty()) return std::move(candidates_);
    look_at_the_best();
    if (is_hopeless()) {
      for (Candidate& candidate : candidates_) {
        if (candidate.why_not.empty())
          candidate.why_not =
              "the error of this explanation is much larger than the error of another explanation";
      }
      return std::move(candidates_);
    }
    follow_the_best();
    finish();
    return std::move(candidates_);
  }

 private:
  /// Returns all permitted causes that a fit can find and that the structure does not contain yet.
  [[nodiscard]] std::vector<Candidate> wanted() const {
    std::vector<Candidate> list;
    for (const Cause& cause : search_.only.empty() ? all_causes() : std::span(search_.only)) {
      if (cause.found_by_fitting && !position_of(current_.point.model, cause))
        list.push_back({cause, std::nullopt, unanswerable(cause, data_.scales)});
    }
    return list;
  }

  void glance_at_all() {
    const std::vector<Scan> scans = places(data_, current_);
    const double unexplained_mm2 = unexplained_in(data_.glimpsed);
    std::atomic<std::size_t> tried{0};
    parallel_for(candidates_.size(), data_.threads, [&](std::size_t i) {
      Candidate& candidate = candidates_[i];
      if (candidate.why_not.empty()) {
        keep(i, coarse_fits(data_, current_, scans, candidate.cause), unexplained_mm2);
        if (fits_[i].empty()) candidate.why_not = "the fit failed from every start point";
      }
      if (search_.progress) search_.progress(++tried, candidates_.size());
    });
  }

  /// Calls `work` for each candidate with a fit. The arguments are the rank of the candidate, its index, and
  /// a function that returns true if the candidate may turn out to be as good as the best one: its mean
  /// square is below the given multiple of the smallest one, and it explains the larger part of what the best
  /// candidate explains.
  template <class Work>
  void for_each_ranked(Work work) {
    const std::vector<std::size_t> order = ranking();
    const double best_mm2 = best_of(order.front());
    const double least_mm2 = limits::majority_share * explained_mm2_[order.front()];
    parallel_for(order.size(), data_.threads, [&](std::size_t rank) {
      const std::size_t i = order[rank];
      work(rank, i, [&, i](double largest_ratio) {
        return best_of(i) < largest_ratio * best_mm2 && explained_mm2_[i] >= least_mm2;
      });
    });
  }

  void look_at_the_best() {
    const double unexplained_mm2 = unexplained_in(data_.thinned);
    for_each_ranked([&](std::size_t rank, std::size_t i, const auto& is_comparable) {
      if (rank < always_looked_at || is_comparable(worth_a_look))
        keep(i, looks(data_, fits_[i]), unexplained_mm2);
    });
  }

  /// Makes the full fit of the best candidate before the full fits of all others. Returns true if the other
  /// candidates need no full fit, because another explanation of the data has a much smaller error.
  bool is_hopeless() {
    if (!search_.is_hopeless) return false;
    leader_ = ranking().front();
    keep(*leader_, {follow(data_, fits_[*leader_])}, unexplained_in(data_.thinned));
    return search_.is_hopeless(best_of(*leader_));
  }

  void follow_the_best() {
    const double unexplained_mm2 = unexplained_in(data_.thinned);
    for_each_ranked([&](std::size_t rank, std::size_t i, const auto& is_comparable) {
      if (i != leader_ && (rank < limits::finalists || is_comparable(near_enough)))
        keep(i, {follow(data_, fits_[i])}, unexplained_mm2);
    });
  }

  /// Makes the final fits of the candidates to all samples.
  void finish() {
    for_each_ranked([&](std::size_t rank, std::size_t i, const auto& is_comparable) {
      const StructureFit& fit = fits_[i].front();
      candidates_[i].fit = rank < finished_candidates || is_comparable(next_to_best)
                               ? fit_structure(data_.records, fit.causes, fit.point)
                               : evaluate_structure(data_.records, fit.causes, fit.point);
    });
  }

  /// Returns the mean square of the structure without a further cause.
  [[nodiscard]] double unexplained_in(const std::vector<Record>& records) const {
    return evaluate_structure(records, current_.causes, current_.point).mean_square_mm2;
  }

  void keep(std::size_t i, std::vector<StructureFit> fits, double unexplained_mm2) {
    fits_[i] = std::move(fits);
    if (!fits_[i].empty()) explained_mm2_[i] = unexplained_mm2 - best_of(i);
  }

  [[nodiscard]] double best_of(std::size_t i) const { return fits_[i].front().mean_square_mm2; }

  /// Returns the indices of the candidates with a fit. They are sorted by the mean square, the smallest
  /// first.
  [[nodiscard]] std::vector<std::size_t> ranking() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      if (!fits_[i].empty()) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return best_of(a) < best_of(b); });
    return order;
  }

  const SearchData& data_;
  const StructureFit& current_;
  const CandidateSearch& search_;
  std::vector<Candidate> candidates_;
  /// For each candidate, its fits to thinned records. The best fit comes first.
  std::vector<std::vector<StructureFit>> fits_;
  /// For each candidate, the decrease of the mean square because of the candidate.
  std::vector<double> explained_mm2_;
  /// Index of the candidate whose full fit was made first.
  std::optional<std::size_t> leader_;
};

}  // namespace

SearchData make_search_data(std::vector<Record> records, const model::Model& given) {
  SearchData data;
  data.records = std::move(records);
  data.given = {given, rest_starts(given, data.records)};
  data.scales = scales_of(data.records);
  const double interval_s = limits::search_interval_in_units * data.scales.time_unit_s;
  for (const Record& record : data.records) {
    data.thinned.push_back(thinned_to(record, interval_s));
    data.glimpsed.push_back(thinned_to(record, 2 * interval_s));
  }
  return data;
}

std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                      const CandidateSearch& search) {
  return CandidateFitter(data, current, search).run();
}

std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                       const Division& division) {
  std::vector<Cause> others;
  for (const Cause& cause : structure.causes) {
    for (const std::string_view id : cause.confounded_with) {
      const Cause other = *find_cause(id);
      if (std::find(others.begin(), others.end(), other) == others.end()) others.push_back(other);
    }
  }
  std::vector<Confounded> list;
  for (const Cause& other : others) {
    for (Candidate& found : fit_candidates(data, structure, {.only = {other}})) {
      if (!found.fit) continue;
      BlockLosses losses = held_out_losses(data.records, division, *found.fit);
      list.push_back({other, std::move(*found.fit), std::move(losses)});
    }
  }
  return list;
}

}  // namespace softgrip::sysid
