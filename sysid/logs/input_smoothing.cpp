#include "sysid/logs/input_smoothing.h"

#include <algorithm>
#include <cmath>

#include "base/statistics.h"
#include "sysid/logs/excitation.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

/// Reversals that are smaller than this multiple of the noise are removed after the smoothing. The noise that
/// is left in the smoothed signal can cause only such small reversals.
constexpr double least_turn = 5;
/// A column is not smoothed if its noise is below this share of its range, because such noise hardly affects
/// the response of a model.
constexpr double negligible_share = 1e-4;

/// Degrees of freedom of Student's t distribution, which describes the increments of the slope. The slope is
/// mostly constant and sometimes jumps. With a normal distribution, a single fast vent would increase the
/// estimated drift rate, and the smoothed signal would then follow the noise in the whole log.
constexpr double heavy_tail = 1;
/// Number of iterations that estimate the scale of the drift rate in each step.
constexpr int rounds = 12;

/// Predicted level and slope before a measurement, with their covariance, and the innovation of the
/// measurement.
struct Estimate {
  double level = 0, slope = 0;
  double ll = 0, ls = 0, ss = 0;
  /// Variance of the innovation; 0: there is no measurement at this time.
  double innovation = 0, variance = 0;
};

/// A signal whose slope is a Wiener process. The variance rate of the slope in a step is `drift_rate` times
/// the element of `shares` for this step.
struct Path {
  std::span<const double> time_s, values;
  double noise = 0;
  /// Variance rate of each step, divided by `drift_rate`. Element i belongs to the step that ends at sample
  /// i.
  std::vector<double> shares;

  [[nodiscard]] double step_s(std::size_t i) const { return time_s[i] - time_s[i - 1]; }
};

/// Predicts level and slope after a step of `dt` [s].
void advance(Estimate& e, double dt, double drift_rate) {
  e.level += dt * e.slope;
  e.ll += 2 * dt * e.ls + dt * dt * e.ss + drift_rate * dt * dt * dt / 3;
  e.ls += dt * e.ss + drift_rate * dt * dt / 2;
  e.ss += drift_rate * dt;
}

/// Runs the Kalman filter. Returns minus twice the log-likelihood of the innovations, up to an additive
/// constant.
double filter(const Path& path, double drift_rate, std::vector<Estimate>* before) {
  const auto& values = path.values;
  const auto first = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  const double range = std::max(width_of(values), path.noise);
  Estimate e{*first, 0, range * range, 0, 0};
  e.ss = std::pow(range / std::max(path.step_s(1), 1e-9), 2);
  double cost = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) advance(e, path.step_s(i), drift_rate * path.shares[i]);
    const bool measured = std::isfinite(values[i]);
    e.variance = measured ? e.ll + path.noise * path.noise : 0;
    e.innovation = measured ? values[i] - e.level : 0;
    if (before != nullptr) (*before)[i] = e;
    if (!measured) continue;
    const double gain_level = e.ll / e.variance, gain_slope = e.ls / e.variance;
    e.level += gain_level * e.innovation;
    e.slope += gain_slope * e.innovation;
    e.ss -= gain_slope * e.ls;
    e.ll *= 1 - gain_level;
    e.ls *= 1 - gain_level;
    cost += std::log(e.variance) + e.innovation * e.innovation / e.variance;
  }
  return cost;
}

/// Returns the drift rate of the slope that has the maximum likelihood. A golden-section search over the
/// logarithm of the drift rate finds this value.
double likeliest_drift_rate(const Path& path) {
  const auto& time_s = path.time_s;
  const double dt = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  // With this drift rate, the drift of the slope changes the level in one sampling interval by about one
  // standard deviation of the noise.
  const double unit = path.noise * path.noise / (dt * dt * dt);
  double low = std::log(unit) - 20, high = std::log(unit) + 12;
  const double golden = (std::sqrt(5.0) - 1) / 2;
  const auto cost = [&](double x) { return filter(path, std::exp(x), nullptr); };
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

/// The smoothed signal, and an estimate of the slope's drift in each step. The estimate is the mean of w'
/// Q^-1 w, where w is the disturbance of the step and Q is the covariance of w for a drift rate of 1.
struct Smooth {
  std::vector<double> level, drift;
};

/// Runs the disturbance smoother backwards over the innovations (Koopman, Biometrika 80, 1993).
Smooth disturbances(const Path& path, double drift_rate) {
  const std::size_t n = path.values.size();
  std::vector<Estimate> before(n);
  filter(path, drift_rate, &before);
  Smooth smooth{std::vector<double>(n), std::vector<double>(n, 0.0)};
  double r0 = 0, r1 = 0, n00 = 0, n01 = 0, n11 = 0;
  for (std::size_t i = n; i-- > 0;) {
    const Estimate& e = before[i];
    if (i + 1 < n) {  // computed for the step after sample i
      const double dt = path.step_s(i + 1);
      r1 += dt * r0;
      n11 += 2 * dt * n01 + dt * dt * n00;
      n01 += dt * n00;
    }
    if (e.variance > 0) {
      const double keep = path.noise * path.noise / e.variance, gain_slope = e.ls / e.variance;
      r0 = keep * r0 - gain_slope * r1 + e.innovation / e.variance;
      n00 = keep * keep * n00 - 2 * keep * gain_slope * n01 + gain_slope * gain_slope * n11 + 1 / e.variance;
      n01 = keep * n01 - gain_slope * n11;
    }
    smooth.level[i] = e.level + e.ll * r0 + e.ls * r1;
    if (i == 0) break;
    const double dt = path.step_s(i), q = drift_rate * path.shares[i];
    const double square =
        dt * dt * dt / 3 * (r0 * r0 - n00) + dt * dt * (r0 * r1 - n01) + dt * (r1 * r1 - n11);
    smooth.drift[i] = std::max(0.0, 2 * q + q * q * square);
  }
  return smooth;
}

}  // namespace

double white_noise_of(std::span<const double> time_s, std::span<const double> values) {
  const std::vector<std::size_t> measured = finite_values(values).samples;
  std::vector<double> deviations;
  for (std::size_t k = 2; k < measured.size(); ++k) {
    // Compute the deviation of a value from the straight line between its neighbours. The divisor makes the
    // standard deviation of the result equal to the standard deviation of a single value.
    const std::size_t before = measured[k - 2], at = measured[k - 1], after = measured[k];
    const double share = (time_s[at] - time_s[before]) / (time_s[after] - time_s[before]);
    const double off = values[at] - (1 - share) * values[before] - share * values[after];
    deviations.push_back(std::abs(off) / std::sqrt(1 + share * share + (1 - share) * (1 - share)));
  }
  // The magnitude of a standard normal variable has a median of 0.6745.
  return median_of(std::span(deviations)) / 0.6745;
}

std::vector<double> smoothed(std::span<const double> time_s, std::span<const double> values, double noise) {
  if (noise <= 0 || values.size() < 3) return {values.begin(), values.end()};
  Path path{time_s, values, noise, std::vector<double>(values.size(), 1.0)};
  double drift_rate = likeliest_drift_rate(path);
  Smooth smooth = disturbances(path, drift_rate);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 1; i < values.size(); ++i)
      path.shares[i] = (heavy_tail + smooth.drift[i] / drift_rate) / (heavy_tail + 2);
    drift_rate = likeliest_drift_rate(path);
    smooth = disturbances(path, drift_rate);
  }
  return smooth.level;
}

double smooth_input(std::span<const double> time_s, std::vector<double>& values) {
  const double noise = white_noise_of(time_s, values);
  if (values.size() < 3 || !(noise > negligible_share * width_of(values))) return 0;
  values = steady_between_turns(smoothed(time_s, values, noise), least_turn * noise);
  return noise;
}

}  // namespace softgrip::sysid
