#include "sysid/diagnosis/search/search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "base/parallel.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/search/scan.h"

namespace softgrip::sysid {
namespace {

/// Interval to which the first look is thinned: a ringing of 30 Hz must still be seen, and the command's
/// corners.
constexpr double look_interval_s = 0.0125;
constexpr FitEffort look{.most_iterations = 12, .tolerance = 1e-5};
constexpr FitEffort full{.most_iterations = 40, .tolerance = 1e-8};
/// Looks that are followed to the end.
constexpr std::size_t followed = 2;
/// By what share of the mean square a form with more numbers must be better.
constexpr double more_numbers_gain = 0.02;
/// So many candidates are followed to the end, first on thinned records, then of these so many on all
/// samples, whatever the others do; more when they are as near.
constexpr std::size_t always_followed = 5;
constexpr double near_enough = 1.4;
constexpr std::size_t always_finished = 4;
constexpr double next_to_best = 1.05;

void sort_and_keep(std::vector<StructureFit>& fits, std::size_t count) {
  std::erase_if(fits, [](const StructureFit& fit) { return !std::isfinite(fit.mean_square_mm2); });
  std::stable_sort(fits.begin(), fits.end(), [](const StructureFit& a, const StructureFit& b) {
    return a.mean_square_mm2 < b.mean_square_mm2;
  });
  if (fits.size() > count) fits.resize(count);
}

/// Where searches on top of `current` may start from.
std::vector<Scan> places(const SearchData& data, const StructureFit& current) {
  std::vector<Scan> scans;
  scans.emplace_back(data.thinned, current.causes, current.point);
  // Recalibration may have walked far from the truth to swallow the effect.
  if (current.causes.empty()) scans.emplace_back(data.thinned, current.causes, data.given);
  return scans;
}

/// The best looks at one candidate, on thinned records, best first.
std::vector<StructureFit> look_at(const SearchData& data, const StructureFit& current,
                                  std::span<const Scan> scans, const Cause& cause) {
  std::vector<Cause> causes = current.causes;
  causes.push_back(cause);
  std::vector<StructureFit> fits;
  for (const FitPoint& start : best_starts(scans, cause, data.scales, fewest_looks)) {
    fits.push_back(fit_structure(data.thinned, causes, start, look));
  }
  sort_and_keep(fits, followed);
  return fits;
}

/// Of two forms of a cause the one with more numbers must be better by more than they could be by chance.
bool is_better(const StructureFit& fit, const StructureFit& best) {
  double needed = 1;
  if (fit.free_parameters > best.free_parameters) needed = 1 - more_numbers_gain;
  if (fit.free_parameters < best.free_parameters) needed = 1 / (1 - more_numbers_gain);
  return fit.mean_square_mm2 < needed * best.mean_square_mm2;
}

StructureFit follow(const SearchData& data, const std::vector<StructureFit>& looks) {
  StructureFit best = fit_structure(data.thinned, looks[0].causes, looks[0].point, full);
  for (std::size_t i = 1; i < looks.size(); ++i) {
    if (looks[i].mean_square_mm2 > 1.3 * looks[0].mean_square_mm2) break;
    StructureFit fit = fit_structure(data.thinned, looks[i].causes, looks[i].point, full);
    if (is_better(fit, best)) best = std::move(fit);
  }
  return best;
}

/// Indices of what there is, smallest mean square first.
std::vector<std::size_t> ranking(const std::vector<std::optional<StructureFit>>& fits) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i]) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fits[a]->mean_square_mm2 < fits[b]->mean_square_mm2;
  });
  return order;
}

}  // namespace

SearchData make_search_data(std::vector<Record> records, const model::Model& given) {
  SearchData data;
  data.records = std::move(records);
  data.given = {given, rest_starts(given, data.records)};
  data.scales = scales_of(data.records);
  for (const Record& record : data.records) data.thinned.push_back(thinned_to(record, look_interval_s));
  return data;
}

std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                      const CandidateSearch& search) {
  std::vector<Cause> wanted;
  for (const Cause& cause : search.only.empty() ? all_causes() : std::span(search.only)) {
    if (cause.found_by_fitting && !position_of(current.point.model, cause)) wanted.push_back(cause);
  }
  std::vector<Candidate> candidates(wanted.size());
  std::vector<std::vector<StructureFit>> looks(wanted.size());
  const std::vector<Scan> scans = places(data, current);
  std::atomic<std::size_t> tried{0};
  parallel_for(wanted.size(), data.threads, [&](std::size_t i) {
    candidates[i] = {wanted[i], std::nullopt, unanswerable(wanted[i], data.scales)};
    if (candidates[i].why_not.empty()) {
      looks[i] = look_at(data, current, scans, wanted[i]);
      if (looks[i].empty()) candidates[i].why_not = "no start led to a fit";
    }
    if (search.progress) search.progress(++tried, wanted.size());
  });

  std::vector<std::optional<StructureFit>> thin(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!looks[i].empty()) thin[i] = looks[i].front();
  }
  std::vector<std::size_t> order = ranking(thin);
  if (order.empty()) return candidates;
  const double best_look = thin[order.front()]->mean_square_mm2;
  if (search.is_hopeless && search.is_hopeless(best_look)) {
    for (Candidate& candidate : candidates) {
      if (candidate.why_not.empty()) candidate.why_not = "far behind another explanation";
    }
    return candidates;
  }
  parallel_for(order.size(), data.threads, [&](std::size_t rank) {
    const std::size_t i = order[rank];
    if (rank < always_followed || thin[i]->mean_square_mm2 < near_enough * best_look) {
      thin[i] = follow(data, looks[i]);
    }
  });
  order = ranking(thin);
  const double best = thin[order.front()]->mean_square_mm2;
  parallel_for(order.size(), data.threads, [&](std::size_t rank) {
    const StructureFit& fit = *thin[order[rank]];
    const bool finish = rank < always_finished || fit.mean_square_mm2 < next_to_best * best;
    candidates[order[rank]].fit = finish ? fit_structure(data.records, fit.causes, fit.point, full)
                                         : evaluate_structure(data.records, fit.causes, fit.point);
  });
  return candidates;
}

}  // namespace softgrip::sysid
