#include "sysid/diagnosis/residual/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/statistics.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t lags = 25;

void add_third_differences(const std::vector<double>& y, std::vector<double>& sizes) {
  for (std::size_t i = 3; i < y.size(); ++i) {
    const double third = y[i] - 3 * y[i - 1] + 3 * y[i - 2] - y[i - 3];
    if (std::isfinite(third)) sizes.push_back(std::abs(third));
  }
}

/// Limit of the unexplained mean square of the model with causes, as a share of the unexplained mean square
/// of the refitted model without causes.
constexpr double may_be_left = 0.15;
/// A stricter limit for a remaining error far above the noise. Data with such a large error determine the
/// parameters of the causes well. A large remaining share must therefore have another source, but a small
/// share may result from the approximate equation of a cause.
struct UnexplainedLimit {
  double noises;  ///< multiple of the noise above which this limit applies
  double share;   ///< limit of the ratio of the mean squares; it replaces may_be_left
};
constexpr std::array unexplained_limits{UnexplainedLimit{3, limits::form_error_share},
                                        UnexplainedLimit{5, 0.02}};

}  // namespace

double measured_noise_mm(const std::vector<Record>& records) {
  // The third difference of white noise has 1 + 9 + 9 + 1 = 20 times the variance of the noise.
  constexpr double inflation = 20.0;
  std::vector<double> sizes;
  for (const Record& record : records) {
    // If the sensor is slower than the log, four adjacent samples with readings are rare. In this case, the
    // third differences are computed from consecutive readings, even if samples without a reading lie between
    // them.
    const std::vector<double> readings = finite_values(record.reading_mm).values;
    const bool is_slow = 5 * readings.size() < 4 * record.reading_mm.size();
    add_third_differences(is_slow ? readings : record.reading_mm, sizes);
  }
  if (sizes.empty()) return 0;
  // The noise is not estimated from the median, because the median of quantised readings has a coarse
  // resolution. The median only defines a limit that excludes wrong samples and corners of the motion. A
  // limit of 4 standard deviations removes 0.1 % of the variance of a normal distribution.
  std::vector<double> sorted = sizes;
  const double bound = 4 * median_of(std::span(sorted)) / 0.6745;
  double sum = 0;
  std::size_t count = 0;
  for (const double size : sizes) {
    if (bound > 0 && size > bound) continue;
    sum += size * size;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / (inflation * static_cast<double>(count)));
}

UnexplainedError unexplained_error_of(const std::vector<std::vector<double>>& residual_mm, double noise_mm) {
  double square = 0;
  std::size_t count = 0;
  std::vector<double> product(lags + 1, 0.0);
  std::vector<double> pairs(lags + 1, 0.0);
  for (const std::vector<double>& r : residual_mm) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      if (std::isnan(r[i])) continue;
      square += r[i] * r[i];
      ++count;
      for (std::size_t lag = 1; lag <= std::min(lags, i); ++lag) {
        if (std::isnan(r[i - lag])) continue;
        product[lag] += r[i] * r[i - lag];
        pairs[lag] += 1;
      }
    }
  }
  UnexplainedError structure;
  if (count == 0) return structure;
  const double mean_square = square / static_cast<double>(count);
  structure.excess_mm = std::sqrt(std::max(0.0, mean_square - noise_mm * noise_mm));
  double sum = 0;
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    if (pairs[lag] > 0) sum += product[lag] / pairs[lag] / mean_square;
  }
  structure.slow_correlation = sum / lags;
  // For n readings of white noise, the mean autocorrelation over 25 lags has a standard deviation of
  // 1/sqrt(25 n). A correlation below 1 % of the variance does not count, even if it is significant. The mean
  // square of the residual is a second criterion: it must not exceed the noise variance by more than the
  // uncertainty of this variance.
  const double known_to = 4 * std::sqrt(6.0 / static_cast<double>(count));
  structure.present = structure.slow_correlation >
                          limits::negligible_share + 4 / std::sqrt(lags * static_cast<double>(count)) ||
                      mean_square > noise_mm * noise_mm * (1 + limits::negligible_share + known_to);
  return structure;
}

bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before, double noise_mm) {
  if (!left.present) return false;
  double may_stay = may_be_left;
  for (const UnexplainedLimit& clear : unexplained_limits) {
    if (left.excess_mm > clear.noises * noise_mm) may_stay = clear.share;
  }
  return left.excess_mm * left.excess_mm > may_stay * before.excess_mm * before.excess_mm;
}

}  // namespace softgrip::sysid
