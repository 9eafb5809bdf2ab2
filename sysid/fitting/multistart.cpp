#include "sysid/fitting/multistart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <random>

#include "base/parallel.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

/// Maximum number of iterations from one start point, for a chain that has no separable parameters.
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
    results[i] = few.run(starts[i]);
    reporter.finished(results[i].rmse_mm);
  });
  const double lowest = lowest_rmse_mm(results);
  const std::vector<double> order_s = branch_time_constants_s(starts.front().model);
  parallel_for(starts.size(), threads, [&](std::size_t i) {
    if (results[i].rmse_mm > higher * lowest) {
      SearchResult again = few.run(starts[i], slow_damping);
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
  parallel_for(worthy.size(), threads,
               [&](std::size_t i) { results[worthy[i]] = all.run(results[worthy[i]].point); });
  for (std::size_t i = 0; i < results.size(); ++i) results[i] = results[place[i]];
  return results;
}

class Drawer {
 public:
  Drawer(const FitSpace& space, const std::vector<Record>& records, std::uint64_t seed)
      : space_(space), scale_(campaign_size(records)), time_unit_s_(time_unit_s(records)), random_(seed) {}

  /// Draws a random point around `given`. A stiffness or damping typically changes by a factor of about two.
  /// Any other model parameter typically changes by the larger of two amounts: 70 % of the value, or 35 % of
  /// its scale in the fit. A pressure peak before a record is drawn uniformly from its range.
  FitPoint around(const FitPoint& given) {
    std::vector<double> z = space_.z(given);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const FreeParameter& p = space_.free()[i];
      if (p.kind == FreeParameter::Kind::peak_before) z[i] = uniform(p.lower_z(), p.upper_z());
      if (p.kind != FreeParameter::Kind::model) continue;
      z[i] += 0.7 * normal_(random_) * (p.logarithmic ? 1 : std::max(std::abs(z[i]), 0.5));
      z[i] = std::clamp(z[i], p.lower_z(), p.upper_z());
    }
    return valid(space_.point(z), given);
  }

  /// Draws a random point at the scale of the data. The scale determines the parameters of Bouc-Wen,
  /// Kelvin-Voigt, delay and lag. The parameters of other blocks are drawn as in around().
  FitPoint from_scale(const FitPoint& given) {
    FitPoint point = around(given);
    const double gain = scale_.span_mm / scale_.largest_kpa;
    for (model::BlockSpec& block : point.model.blocks) {
      std::vector<double>& v = block.values;
      if (model::is<model::BoucWen>(block)) {
        const double growing = between(0.5, 8) / scale_.largest_kpa;
        const double eta = growing * uniform(0.2, 0.9);
        v[0] = gain * uniform(0.2, 1);
        v[1] = v[0] * uniform(0.2, 1);
        v[2] = growing - eta;
        v[3] = eta;
      } else if (model::is<model::KelvinVoigt>(block)) {
        branches(gain, v);
      } else if (model::is<model::TransportDelay>(block) || model::is<model::ValveLag>(block)) {
        v[0] = time_unit_s_ * uniform(0.005, 0.3);
      }
    }
    // Converts the point to the coordinates of the fit and back. This conversion resets all parameters that
    // are not fitted to their given values.
    return valid(space_.point(space_.z(point)), given);
  }

 private:
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  double between(double lower, double upper) { return std::exp(uniform(std::log(lower), std::log(upper))); }

  /// Draws time constants of creep branches, up to half the length of the longest log. If the time constants
  /// of the given model increase from branch to branch, the drawn ones increase too; otherwise they decrease.
  void branches(double gain, std::vector<double>& v) {
    const std::size_t count = (v.size() - 1) / 2;
    std::vector<double> time_constants;
    for (std::size_t b = 0; b < count; ++b)
      time_constants.push_back(between(0.05 * time_unit_s_, scale_.longest_s / 2));
    std::sort(time_constants.begin(), time_constants.end(), std::greater<>());
    const bool rising = count > 1 && v[2] / v[1] < v[4] / v[3];
    if (rising) std::reverse(time_constants.begin(), time_constants.end());
    for (std::size_t b = 0; b < count; ++b) {
      v[1 + 2 * b] = static_cast<double>(count) / (gain * uniform(0.1, 1));
      v[2 + 2 * b] = v[1 + 2 * b] * time_constants[b];
    }
  }

  static FitPoint valid(const FitPoint& point, const FitPoint& given) {
    return model::validate(point.model).empty() ? point : given;
  }

  const FitSpace& space_;
  CampaignSize scale_;
  double time_unit_s_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

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

std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                  const std::vector<Record>& records, std::size_t count, std::uint64_t seed) {
  std::vector<FitPoint> starts{given};
  for (std::size_t i = 1; i < count; ++i) {
    // Every start point has its own seed, so that the first 10 of 20 start points equal the start points of a
    // search with 10 start points.
    std::seed_seq sequence{seed, static_cast<std::uint64_t>(i)};
    std::vector<std::uint64_t> derived(1);
    sequence.generate(derived.begin(), derived.end());
    Drawer drawer(space, records, derived.front());
    starts.push_back(i % 2 == 1 ? drawer.from_scale(given) : drawer.around(given));
  }
  return starts;
}

model::Model base_model(const std::vector<Log>& logs, std::size_t branches) {
  return base_model(make_records(logs, {}), branches);
}

model::Model base_model(const std::vector<Record>& records, std::size_t branches) {
  const CampaignSize scale = campaign_size(records);
  const double gain = scale.span_mm / std::max(scale.largest_kpa, 1e-6);
  model::Model model;
  model.name = "identified";
  if (!records.empty()) model.output_unit = records.front().output_unit;
  model.source = "start values from the scale of the data";
  const double saturation_per_kpa = 1 / std::max(scale.largest_kpa, 1e-6);
  model = model::with_block(std::move(model),
                            {model::block_type<model::BoucWen>(),
                             {0.6 * gain, 0.3 * gain, saturation_per_kpa, saturation_per_kpa, 1}});
  // The spring k0 is practically rigid, so alpha alone is the instantaneous gain. The data determine only the
  // sum alpha + 1/k0.
  std::vector<double> creep{1e9};
  const double slowest = std::max(scale.longest_s / 4, 1.0);
  for (std::size_t b = 0; b < branches; ++b) {
    const double share = branches > 1 ? static_cast<double>(b) / static_cast<double>(branches - 1) : 0.5;
    const double time_constant = slowest * std::pow(0.4 / slowest, share);
    const double stiffness = static_cast<double>(branches) / (0.4 * gain);
    creep.insert(creep.end(), {stiffness, stiffness * time_constant});
  }
  return model::with_block(std::move(model), {model::block_type<model::KelvinVoigt>(), std::move(creep)});
}

}  // namespace softgrip::sysid
