#include "sysid/fitting/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>

#include "base/parallel.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/named.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

/// Maximum number of iterations from one start point.
constexpr int search_iterations = 60;
constexpr int chain_search_iterations = 40;
/// Number of samples in the coarse fits, which start at many points. With a larger number of samples, the
/// coarse fits do not find better minima.
constexpr std::size_t samples_of_a_look = 4000;
/// A search is repeated with a larger initial damping if its RMSE is above this multiple of the lowest RMSE
/// of all searches.
constexpr double higher = 1.02;
constexpr double slow_damping = 10;
/// A minimum is refined on all samples if its RMSE is at most this multiple of the lowest RMSE.
constexpr double not_far = 1.3;
/// Two results count as the same minimum if their distance in the coordinates of the fit is below this value.
constexpr double same_place = 0.02;

/// Reports the progress of a search that runs in several threads. Only one thread at a time calls the
/// callback.
class ProgressReporter {
 public:
  ProgressReporter(const ShowProgress& show, std::size_t starts)
      : show_(show), progress_{0, starts, std::numeric_limits<double>::infinity(), {}} {}
  void finished(double rmse_mm) {
    const std::lock_guard lock(mutex_);
    ++progress_.done;
    progress_.best_rmse_mm = std::min(progress_.best_rmse_mm, rmse_mm);
    if (show_) show_(progress_);
  }

 private:
  const ShowProgress& show_;
  std::mutex mutex_;
  Progress progress_;
};

double lowest_rmse_mm(const std::vector<SearchResult>& results) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const SearchResult& r : results) lowest = std::min(lowest, r.rmse_mm);
  return lowest;
}

/// Returns, for each search result, the index of the first result that belongs to the same minimum of the
/// cost.
std::vector<std::size_t> places(const FitSpace& space, const std::vector<SearchResult>& results) {
  std::vector<std::size_t> firsts;
  std::vector<std::vector<double>> at;
  std::vector<std::size_t> place(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    at.push_back(space.z(results[i].point));
    const auto near = [&](std::size_t j) {
      double distance = 0;
      for (std::size_t k = 0; k < at[i].size(); ++k)
        distance = std::max(distance, std::abs(at[i][k] - at[j][k]));
      return distance < same_place;
    };
    const auto first = std::find_if(firsts.begin(), firsts.end(), near);
    place[i] = first == firsts.end() ? i : *first;
    if (first == firsts.end()) firsts.push_back(i);
  }
  return place;
}

/// Searches from all start points on the records of `few`. Repeats a search with more damping if its RMSE
/// exceeds the lowest RMSE by more than 2 %.
std::vector<SearchResult> look(const SeparableSearch& few, const std::vector<FitPoint>& starts,
                               unsigned threads, const ShowProgress& progress) {
  ProgressReporter reporter(progress, starts.size());
  std::vector<SearchResult> results(starts.size());
  parallel_for(starts.size(), threads, [&](std::size_t i) {
    results[i] = few.run(starts[i], search_iterations);
    reporter.finished(results[i].rmse_mm);
  });
  const double lowest = lowest_rmse_mm(results);
  const std::vector<double> order_s = branch_time_constants_s(starts.front().model);
  parallel_for(starts.size(), threads, [&](std::size_t i) {
    if (results[i].rmse_mm > higher * lowest) {
      SearchResult again = few.run(starts[i], search_iterations, slow_damping);
      if (again.rmse_mm < results[i].rmse_mm) results[i] = std::move(again);
    }
    order_branches(order_s, results[i].point);
  });
  return results;
}

std::vector<SearchResult> search_separable(const SeparableSearch& all, const FitSpace& space,
                                           const std::vector<Record>& records,
                                           const std::vector<FitPoint>& starts, unsigned threads,
                                           const ShowProgress& progress) {
  std::size_t samples = 0;
  for (const Record& record : records) samples += record.size();
  const std::size_t stride = starts.size() > 1 ? samples / samples_of_a_look : 1;
  if (stride <= 1) return look(all, starts, threads, progress);
  std::vector<Record> thin;
  thin.reserve(records.size());
  for (const Record& record : records) thin.push_back(thinned_record(record, stride));
  std::vector<SearchResult> results = look(*SeparableSearch::make(thin, space), starts, threads, progress);

  const std::vector<std::size_t> place = places(space, results);
  const double lowest = lowest_rmse_mm(results);
  std::vector<std::size_t> worthy;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (place[i] == i && results[i].rmse_mm <= not_far * lowest) worthy.push_back(i);
  }
  parallel_for(worthy.size(), threads, [&](std::size_t i) {
    results[worthy[i]] = all.run(results[worthy[i]].point, search_iterations);
  });
  for (std::size_t i = 0; i < results.size(); ++i) results[i] = results[place[i]];
  return results;
}

}  // namespace

std::vector<SearchResult> search(const FitSpace& space, const std::vector<Record>& records,
                                 const std::vector<FitPoint>& starts, unsigned threads,
                                 const ShowProgress& progress) {
  if (const auto separable = SeparableSearch::make(records, space)) {
    return search_separable(*separable, space, records, starts, threads, progress);
  }
  std::vector<SearchResult> results(starts.size());
  ProgressReporter reporter(progress, starts.size());
  const auto residuals = residuals_for(records, space);
  parallel_for(starts.size(), threads, [&](std::size_t i) {
    MinimiseOptions coarse;
    coarse.most_iterations = starts.size() > 1 ? chain_search_iterations : 1;
    coarse.tolerance = 1e-6;
    const Minimum minimum = minimise(*residuals, space.z(starts[i]), coarse);
    results[i] = {space.point(minimum.z), minimum.rmse_mm, minimum.iterations, minimum.converged};
    reporter.finished(results[i].rmse_mm);
  });
  return results;
}

void order_branches(const std::vector<double>& like_s, FitPoint& point) {
  const auto position = model::position_of<model::KelvinVoigt>(point.model);
  if (!position) return;
  const auto slowest_first = [](const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
    return order;
  };
  const std::vector<std::size_t> to = slowest_first(like_s);
  const std::vector<std::size_t> from = slowest_first(branch_time_constants_s(point.model));
  std::vector<double>& v = point.model.blocks[*position].values;
  const std::vector<double> old = v;
  const std::vector<StartState> old_starts = point.starts;
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
    v[1 + 2 * to[i]] = old[1 + 2 * from[i]];
    v[2 + 2 * to[i]] = old[2 + 2 * from[i]];
    for (std::size_t r = 0; r < point.starts.size(); ++r) {
      point.starts[r].unsettled_mm[to[i]] = old_starts[r].unsettled_mm[from[i]];
    }
  }
}

}  // namespace softgrip::sysid
