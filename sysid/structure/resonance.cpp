#include "sysid/structure/resonance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/inertia.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/structure/published_element.h"

namespace softgrip::sysid {
namespace {

constexpr int periods = 8;
constexpr std::array damping_ratios{0.1, 0.5};
/// Shortest period of the search, in sampling intervals. If the period is shorter, the samples do not
/// determine the amplitude of a sine.
constexpr double shortest_in_intervals = 6;
/// Upper limits of the periods in the search: `longest_share` as a share of the longest record, and
/// `longest_in_units` in units of time_unit_s(). The smaller one applies.
constexpr double longest_share = 0.1;
constexpr double longest_in_units = 10;

void put(FitPoint& point, double period_s, double damping_ratio) {
  point.model = model::with_block(
      std::move(point.model),
      model::block_of<model::Inertia>({{"period_s", period_s}, {"damping_ratio", damping_ratio}}));
}

/// Returns a copy of the point without dead time. The time constants of the lag are increased by the dead
/// time minus the latency of the mode. This is necessary because the fit without the mode represents the slow
/// rise of the mode partly by a dead time. This dead time prevents the search from finding the mode. Returns
/// nullopt if the model has no dead time or no lag.
std::optional<FitPoint> with_dead_time_as_lag(FitPoint point, double mode_latency_s) {
  const auto delay = model::position_of<model::TransportDelay>(point.model);
  if (!delay) return std::nullopt;
  const double moved_s = std::exchange(point.model.blocks[*delay].values[0], 0.0) - mode_latency_s;
  const auto lag = std::find_if(point.model.blocks.begin(), point.model.blocks.end(), [](const auto& block) {
    return model::is<model::AsymmetricValveLag>(block);
  });
  if (lag == point.model.blocks.end()) return std::nullopt;
  for (double& time_constant_s : lag->values)
    time_constant_s = std::max(time_constant_s + moved_s, 0.1 * time_constant_s);
  return point;
}

/// Returns the indices of the parameters of resonance, delay, lags and rate limit in the list of all
/// parameters.
std::vector<std::size_t> latencies(const model::Model& model) {
  constexpr std::array movable{
      model::block_type<model::TransportDelay>(),     model::block_type<model::ValveLag>(),
      model::block_type<model::AsymmetricValveLag>(), model::block_type<model::RateLimit>(),
      model::block_type<model::ChamberLag>(),         model::block_type<model::Inertia>()};
  std::vector<std::size_t> flat;
  std::size_t at = 0;
  for (const model::BlockSpec& block : model.blocks) {
    for (std::size_t i = 0; i < block.values.size(); ++i, ++at) {
      if (std::find(movable.begin(), movable.end(), block.type) != movable.end()) flat.push_back(at);
    }
  }
  return flat;
}

ResonantFit minimised(const FitPoint& from, const std::vector<Record>& records, ResonanceFit fit) {
  const bool all = fit == ResonanceFit::complete;
  FitSpace space(from.model, records, all ? free_numbers(from.model) : latencies(from.model));
  if (!all) space.hold_starts(from.starts);
  MinimiseOptions options;
  options.most_iterations = 20;
  options.tolerance = 1e-6;
  const auto residuals = residuals_for(records, space);
  const Minimum minimum = minimise(*residuals, space.z(from), options);
  return {space.point(minimum.z), minimum.rmse_mm};
}

/// Continues the fit `found` with all parameters if `fit` requests them. Returns the new fit only if its
/// error is smaller.
ResonantFit completed(ResonantFit found, const std::vector<Record>& records, ResonanceFit fit) {
  if (fit != ResonanceFit::complete || found.point.model.blocks.empty()) return found;
  ResonantFit complete = minimised(found.point, records, fit);
  return complete.rmse_mm < found.rmse_mm ? complete : found;
}

}  // namespace

ResonantFit with_resonance(const FitPoint& point, const std::vector<Record>& records, ResonanceFit fit) {
  double interval_s = std::numeric_limits<double>::infinity(), length_s = 0;
  for (const Record& record : records) {
    interval_s = std::min(interval_s, record.mean_interval_s());
    length_s = std::max(length_s, record.length_s());
  }
  const double from_s = shortest_in_intervals * interval_s;
  const double to_s =
      std::max(from_s, std::min(longest_share * length_s, longest_in_units * time_unit_s(records)));
  // Best start point for each damping ratio, with and without a dead time. In the form without a dead time,
  // the lag is larger. The two forms are not compared with each other, because a fit without the mode favours
  // the form with the dead time.
  std::array<ResonantFit, 2 * damping_ratios.size()> best;
  for (int i = 0; i < periods; ++i) {
    const double period_s = from_s * std::pow(to_s / from_s, static_cast<double>(i) / (periods - 1));
    for (std::size_t k = 0; k < best.size(); ++k) {
      const double damping_ratio = damping_ratios[k / 2];
      const std::optional<FitPoint> from =
          k % 2 == 0 ? point : with_dead_time_as_lag(point, damping_ratio * period_s / std::numbers::pi);
      if (!from) continue;
      ResonantFit start{*from, 0};
      put(start.point, period_s, damping_ratio);
      start.rmse_mm = rmse_of(start.point.model, start.point.starts, records);
      if (start.rmse_mm < best[k].rmse_mm) best[k] = std::move(start);
    }
  }
  ResonantFit found;
  for (const ResonantFit& start : best) {
    if (start.point.model.blocks.empty()) continue;
    ResonantFit end = minimised(start.point, records, ResonanceFit::dynamics);
    if (end.rmse_mm < found.rmse_mm) found = std::move(end);
  }
  return completed(std::move(found), records, fit);
}

FitPoint with_resonance_of(const FitPoint& resonant, FitPoint point, const std::vector<Record>& records,
                           ResonanceFit fit) {
  const model::BlockSpec& mode = *model::find_block<model::Inertia>(resonant.model);
  put(point, model::value<model::Inertia>(mode, "period_s"),
      model::value<model::Inertia>(mode, "damping_ratio"));
  return completed(minimised(point, records, ResonanceFit::dynamics), records, fit).point;
}

}  // namespace softgrip::sysid
