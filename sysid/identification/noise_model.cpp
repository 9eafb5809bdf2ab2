#include "sysid/identification/uncertainty.h"

#include <algorithm>
#include <cmath>

#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {

Autocovariance autocovariance_of(const std::vector<std::span<const double>>& series) {
  Autocovariance covariance;
  for (const auto& s : series) covariance.samples += finite_count(s);
  const auto lags = std::min<std::size_t>(40, covariance.samples / 10);
  covariance.lags.assign(lags + 1, 0.0);
  for (const auto& s : series) {
    for (std::size_t lag = 0; lag <= lags; ++lag) {
      double sum = 0;
      for (std::size_t i = lag; i < s.size(); ++i) {
        const double product = s[i] * s[i - lag];
        if (std::isfinite(product)) sum += product;
      }
      covariance.lags[lag] += sum / static_cast<double>(covariance.samples);
    }
  }
  return covariance;
}

NoiseModel fit_noise(const Autocovariance& given) {
  const std::vector<double>& covariance = given.lags;
  const std::size_t count = given.samples;
  const std::size_t lags = covariance.size() - 1;
  NoiseModel noise;
  if (count == 0 || !(covariance[0] >= 0)) return noise;
  noise.deviation_mm = std::sqrt(covariance[0]);
  noise.innovation_mm = noise.deviation_mm;
  noise.effective_samples = static_cast<double>(count);
  if (covariance[0] <= 0) return noise;
  noise.lag1_correlation = lags >= 1 ? covariance[1] / covariance[0] : 0;

  // Computes the best linear predictor of each order from the predictor of the order below (Levinson-Durbin
  // recursion).
  std::vector<double> a;
  double variance = covariance[0];
  double best = static_cast<double>(count) * std::log(variance);
  for (std::size_t order = 1; order <= lags && variance > 1e-12 * covariance[0]; ++order) {
    double reflection = covariance[order];
    for (std::size_t i = 0; i < a.size(); ++i) reflection -= a[i] * covariance[order - 1 - i];
    reflection /= variance;
    if (!(std::abs(reflection) < 0.99999)) break;
    std::vector<double> next(order);
    for (std::size_t i = 0; i + 1 < order; ++i) next[i] = a[i] - reflection * a[order - 2 - i];
    next[order - 1] = reflection;
    a = std::move(next);
    variance *= 1 - reflection * reflection;
    const double criterion =
        static_cast<double>(count) * std::log(variance) + 2.0 * static_cast<double>(order);
    if (criterion < best - 1e-9) {
      best = criterion;
      noise.coefficients = a;
      noise.innovation_mm = std::sqrt(variance);
    }
  }
  double sum = 1;
  for (const double coefficient : noise.coefficients) sum -= coefficient;
  const double long_run = noise.innovation_mm * noise.innovation_mm / std::max(sum * sum, 1e-12);
  noise.effective_samples = static_cast<double>(count) * std::min(1.0, covariance[0] / long_run);
  return noise;
}

}  // namespace softgrip::sysid
