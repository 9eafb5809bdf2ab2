#include "tools/commissioning/line_fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace softgrip::tools::calibrate {
namespace {

/// Smallest ratio of two sums of squared residuals at which a bend is significant: the sum for a straight
/// line divided by the sum for a line with a bend. For hundreds of readings, noise alone does not cause a
/// ratio of 1.5 (F test with two extra parameters).
constexpr double improvement = 1.5;
/// Number of positions along the ramp at which the fit tries a bend.
constexpr int bends = 200;
/// Smallest rise of the response that counts as a rise, as a multiple of the scatter of the response about
/// the fit.
constexpr double least_rise = 5;
/// Largest permitted error of a line, and largest permitted difference between repeated measurements at one
/// position. Both are shares of the difference between the references of the two positions.
constexpr double most_error_share = 0.1;

struct Means {
  double electrical = 0;
  double reference = 0;
  std::size_t count = 0;
};

Means means_of(const std::vector<Visit>& visits, std::optional<bool> upper) {
  Means means;
  for (const Visit& visit : visits) {
    if (upper && visit.upper != *upper) continue;
    means.electrical += visit.electrical;
    means.reference += visit.reference;
    ++means.count;
  }
  if (means.count == 0) return means;
  means.electrical /= static_cast<double>(means.count);
  means.reference /= static_cast<double>(means.count);
  return means;
}

double slope_of(const std::vector<Visit>& visits, const Means& all) {
  double products = 0;
  double squares = 0;
  for (const Visit& visit : visits) {
    const double x = visit.electrical - all.electrical;
    products += x * (visit.reference - all.reference);
    squares += x * x;
  }
  return products / squares;
}

double spread_at(const std::vector<Visit>& visits, const std::vector<double>& residuals, bool upper) {
  double lowest = 0;
  double highest = 0;
  bool any = false;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (visits[i].upper != upper) continue;
    lowest = any ? std::min(lowest, residuals[i]) : residuals[i];
    highest = any ? std::max(highest, residuals[i]) : residuals[i];
    any = true;
  }
  return highest - lowest;
}

double largest(const std::vector<Visit>& visits, double Visit::*of) {
  double value = 0;
  for (const Visit& visit : visits) value = std::max(value, std::abs(visit.*of));
  return value;
}

/// Returns the standard uncertainty of one point of the line. The uncertainty combines the noise of a mean,
/// the drift and the repeatability.
double uncertainty(const std::vector<Visit>& visits, const Line& line) {
  double of_means = 0;
  for (const Visit& visit : visits) {
    const double mean = visit.noise / std::sqrt(static_cast<double>(std::max<std::size_t>(visit.count, 1)));
    of_means = std::max(of_means, std::abs(mean * line.slope));
  }
  const double drift = std::abs(largest(visits, &Visit::drift) * line.slope);
  return std::hypot(of_means, drift, line.repeat_spread.value_or(0) / 2);
}

/// Fits a response that is constant up to the bend and rises linearly beyond it, by least squares. Returns
/// the sum of squared residuals.
double fit_bend(const std::vector<double>& command, const std::vector<double>& response, double bend,
                double& gain) {
  const auto count = static_cast<double>(command.size());
  double sum_x = 0;
  double sum_y = 0;
  double sum_xx = 0;
  double sum_xy = 0;
  double sum_yy = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const double x = std::max(command[i] - bend, 0.0);
    sum_x += x;
    sum_y += response[i];
    sum_xx += x * x;
    sum_xy += x * response[i];
    sum_yy += response[i] * response[i];
  }
  const double of_x = sum_xx - sum_x * sum_x / count;
  const double of_xy = sum_xy - sum_x * sum_y / count;
  const double of_y = sum_yy - sum_y * sum_y / count;
  gain = of_x > 0 ? of_xy / of_x : 0;
  return std::max(of_y - gain * of_xy, 0.0);
}

}  // namespace

tl::expected<Line, std::string> fit_line(const std::vector<Visit>& visits, const Demands& demands,
                                         const std::string& unit, const std::string& electrical) {
  const Means low = means_of(visits, false);
  const Means high = means_of(visits, true);
  if (low.count == 0 || high.count == 0)
    return tl::unexpected(std::string("two different positions are required"));
  for (const Visit& visit : visits) {
    if (!std::isfinite(visit.reference) || !std::isfinite(visit.electrical)) {
      return tl::unexpected(std::string("a value is not a number"));
    }
  }
  const double span = std::abs(high.reference - low.reference);
  const double electrical_span = std::abs(high.electrical - low.electrical);
  if (span < demands.least_span) {
    return tl::unexpected(fmt::format(
        "the two points are too close: the distance is {:.4g} {}, but at least {:.4g} is required", span,
        unit, demands.least_span));
  }
  if (electrical_span < demands.least_electrical_span) {
    return tl::unexpected(
        fmt::format("the signal changes too little: between points with a distance of {2:.4g} {3}, it "
                    "changes by {0:.4g} {1}, but at least {4:.4g} {1} are required",
                    electrical_span, electrical, span, unit, demands.least_electrical_span));
  }
  const double noise = largest(visits, &Visit::noise);
  if (noise > demands.most_noise_share * electrical_span) {
    return tl::unexpected(
        fmt::format("too much noise: the noise is {:.4g} {}. The two points differ by {:.4g} {}, and the "
                    "noise may be at most {:g} % of this difference",
                    noise, electrical, electrical_span, electrical, 100 * demands.most_noise_share));
  }
  Line line;
  const Means all = means_of(visits, std::nullopt);
  line.slope = slope_of(visits, all);
  const auto at = [&](double x) { return all.reference + line.slope * (x - all.electrical); };
  line.points = {low.electrical, at(low.electrical), high.electrical, at(high.electrical)};
  for (const Visit& visit : visits) line.residuals.push_back(visit.reference - at(visit.electrical));
  if (low.count > 1 && high.count > 1) {
    line.repeat_spread =
        std::max(spread_at(visits, line.residuals, false), spread_at(visits, line.residuals, true));
    if (*line.repeat_spread > most_error_share * span) {
      return tl::unexpected(
          fmt::format("not repeatable: repeated measurements at one position differ by {:.4g} {}, but the "
                      "two positions differ only by {:.4g}",
                      *line.repeat_spread, unit, span));
    }
  }
  line.noise = noise * std::abs(line.slope);
  line.error = 2 * uncertainty(visits, line);
  if (line.error > most_error_share * span) {
    return tl::unexpected(fmt::format(
        "too much drift or noise: the error of the line is {0:.4g} {1}, but the two positions differ only by "
        "{2:.4g} {1}. Within an averaging time, the readings drift by up to {3:.4g} {1}: increase --settle-s",
        line.error, unit, span, std::abs(largest(visits, &Visit::drift) * line.slope)));
  }
  return line;
}

std::optional<DeadZone> find_dead_zone(const std::vector<double>& command,
                                       const std::vector<double>& response) {
  if (command.size() < 10 || command.size() != response.size()) return std::nullopt;
  const auto [first, last] = std::minmax_element(command.begin(), command.end());
  const double span = *last - *first;
  DeadZone best;
  double straight_gain = 0;
  const double straight = fit_bend(command, response, *first, straight_gain);
  double least = straight;
  best = {*first, straight_gain, 0, false};
  for (int i = 1; i < bends; ++i) {
    const double bend = *first + span * i / bends;
    double gain = 0;
    const double left = fit_bend(command, response, bend, gain);
    if (left >= least || gain <= 0) continue;
    least = left;
    best = {bend, gain, 0, false};
  }
  best.scatter = std::sqrt(least / static_cast<double>(command.size()));
  if (best.gain <= 0 || best.gain * (*last - best.end) < least_rise * best.scatter) return std::nullopt;
  best.significant = straight > improvement * least;
  return best;
}

}  // namespace softgrip::tools::calibrate
