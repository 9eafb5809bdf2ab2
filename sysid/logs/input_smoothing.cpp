#include "sysid/logs/input_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.h"

namespace softgrip::sysid {
namespace {

/// Below this share of a column's range its noise changes no answer.
constexpr double negligible_share = 1e-4;

/// Largest minus smallest finite value; negative without one.
double range_of(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return high - low;
}

/// Level and slope with their covariance.
struct Estimate {
  double level = 0, slope = 0;
  double ll = 0, ls = 0, ss = 0;
};

Estimate predicted(const Estimate& e, double dt, double wandering) {
  Estimate p = e;
  p.level = e.level + dt * e.slope;
  p.ll = e.ll + 2 * dt * e.ls + dt * dt * e.ss + wandering * dt * dt * dt / 3;
  p.ls = e.ls + dt * e.ss + wandering * dt * dt / 2;
  p.ss = e.ss + wandering * dt;
  return p;
}

/// One pass forwards. Returns minus twice the log-likelihood of the innovations.
double filter(std::span<const double> time_s, std::span<const double> values, double noise, double wandering,
              std::vector<Estimate>* before, std::vector<Estimate>* after) {
  const auto first = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  const double range = std::max(range_of(values), noise);
  Estimate e{*first, 0, range * range, 0, 0};
  e.ss = std::pow(range / std::max(time_s[1] - time_s[0], 1e-9), 2);
  double cost = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Estimate p = i == 0 ? e : predicted(e, time_s[i] - time_s[i - 1], wandering);
    e = p;
    if (std::isfinite(values[i])) {
      const double variance = p.ll + noise * noise;
      const double innovation = values[i] - p.level;
      const double gain_level = p.ll / variance, gain_slope = p.ls / variance;
      e.level += gain_level * innovation;
      e.slope += gain_slope * innovation;
      e.ll = p.ll * (1 - gain_level);
      e.ls = p.ls * (1 - gain_level);
      e.ss = p.ss - gain_slope * p.ls;
      cost += std::log(variance) + innovation * innovation / variance;
    }
    if (before != nullptr) (*before)[i] = p;
    if (after != nullptr) (*after)[i] = e;
  }
  return cost;
}

/// The wandering of the slope, per second, of greatest likelihood: golden section over its logarithm.
double likeliest_wandering(std::span<const double> time_s, std::span<const double> values, double noise) {
  const double dt = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const double unit = noise * noise / (dt * dt * dt);  // where a sample's wandering is as large as the noise
  double low = std::log(unit) - 20, high = std::log(unit) + 12;
  const double golden = (std::sqrt(5.0) - 1) / 2;
  const auto cost = [&](double x) { return filter(time_s, values, noise, std::exp(x), nullptr, nullptr); };
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = cost(left), at_right = cost(right);
  while (high - low > 0.2) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - golden * (high - low);
      at_left = cost(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + golden * (high - low);
      at_right = cost(right);
    }
  }
  return std::exp((low + high) / 2);
}

}  // namespace

double white_noise_of(std::span<const double> time_s, std::span<const double> values) {
  std::vector<double> deviations;
  for (std::size_t i = 2; i < values.size(); ++i) {
    // From the straight line between both neighbours, in units of one value's noise.
    const double share = (time_s[i - 1] - time_s[i - 2]) / (time_s[i] - time_s[i - 2]);
    const double off = values[i - 1] - (1 - share) * values[i - 2] - share * values[i];
    if (std::isfinite(off))
      deviations.push_back(std::abs(off) / std::sqrt(1 + share * share + (1 - share) * (1 - share)));
  }
  return median_of(std::span(deviations)) / 0.6745;  // the median of a standard normal's magnitude
}

std::vector<double> smoothed(std::span<const double> time_s, std::span<const double> values, double noise) {
  std::vector<double> result(values.begin(), values.end());
  if (noise <= 0 || values.size() < 3) return result;
  const double wandering = likeliest_wandering(time_s, values, noise);
  std::vector<Estimate> before(values.size()), after(values.size());
  filter(time_s, values, noise, wandering, &before, &after);
  Estimate later = after.back();
  result.back() = later.level;
  for (std::size_t i = values.size() - 1; i-- > 0;) {
    const Estimate& f = after[i];
    const Estimate& p = before[i + 1];
    const double dt = time_s[i + 1] - time_s[i];
    // The smoother's gain: cov(f) F' cov(p)^-1.
    const double fl = f.ll + dt * f.ls, fs = f.ls + dt * f.ss;
    const double determinant = p.ll * p.ss - p.ls * p.ls;
    const double a = (fl * p.ss - f.ls * p.ls) / determinant, b = (f.ls * p.ll - fl * p.ls) / determinant;
    const double c = (fs * p.ss - f.ss * p.ls) / determinant, d = (f.ss * p.ll - fs * p.ls) / determinant;
    const double level = later.level - p.level, slope = later.slope - p.slope;
    later = {f.level + a * level + b * slope, f.slope + c * level + d * slope, 0, 0, 0};
    result[i] = later.level;
  }
  return result;
}

double smooth_input(std::span<const double> time_s, std::vector<double>& values) {
  const double noise = white_noise_of(time_s, values);
  if (values.size() < 3 || !(noise > negligible_share * range_of(values))) return 0;
  values = smoothed(time_s, values, noise);
  return noise;
}

}  // namespace softgrip::sysid
