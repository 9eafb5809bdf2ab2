#include "sysid/diagnosis/residual/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/statistics.h"
#include "sysid/diagnosis/residual/resolution.h"
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

using Residual = std::vector<std::vector<double>>;

struct Moments {
  std::size_t count = 0;  ///< number of readings
  double mean_square_mm2 = 0;
  double slow_mm2 = 0;  ///< mean autocovariance over the first `lags` lags
};

Moments moments_of(const Residual& residual_mm) {
  Moments moments;
  double square = 0;
  std::array<double, lags + 1> product{}, pairs{};
  for (const std::vector<double>& r : residual_mm) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      if (std::isnan(r[i])) continue;
      square += r[i] * r[i];
      ++moments.count;
      for (std::size_t lag = 1; lag <= std::min(lags, i); ++lag) {
        if (std::isnan(r[i - lag])) continue;
        product[lag] += r[i] * r[i - lag];
        pairs[lag] += 1;
      }
    }
  }
  if (moments.count == 0) return moments;
  moments.mean_square_mm2 = square / static_cast<double>(moments.count);
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    if (pairs[lag] > 0) moments.slow_mm2 += product[lag] / pairs[lag] / lags;
  }
  return moments;
}

/// Returns the errors by rounding that the residual has if the prediction is correct.
Residual rounding_errors(Residual residual_mm, double step_mm) {
  for (std::vector<double>& r : residual_mm) {
    for (double& each : r) each -= step_mm * std::round(each / step_mm);
  }
  return residual_mm;
}

/// Returns the number of changes of the reading in a prediction that is rounded to steps.
std::size_t steps_in(const Residual& rounding_mm, double step_mm) {
  std::size_t steps = 0;
  for (const std::vector<double>& error : rounding_mm) {
    for (std::size_t i = 1; i < error.size(); ++i)
      steps += std::abs(error[i] - error[i - 1]) > step_mm / 2 ? 1U : 0U;
  }
  return steps;
}

}  // namespace

double white_noise_mm(const std::vector<Record>& records) {
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

double measured_noise_mm(const std::vector<Record>& records) {
  const double white_mm = white_noise_mm(records);
  double step_mm = 0;
  for (const Record& record : records) step_mm = std::max(step_mm, record.step_mm);
  if (step_mm == 0) return white_mm;
  return std::hypot(std::sqrt(rounding_variance_mm2(step_mm)),
                    noise_before_rounding_mm(records, step_mm, white_mm));
}

UnexplainedError unexplained_error_of(const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                      double step_mm) {
  UnexplainedError structure;
  const Moments residual = moments_of(residual_mm);
  if (residual.count == 0) return structure;
  double expected_mm2 = noise_mm * noise_mm, slow_mm2 = residual.slow_mm2;
  auto independent = static_cast<double>(residual.count);
  if (step_mm > 0) {
    const Residual errors_mm = rounding_errors(residual_mm, step_mm);
    const Moments rounding = moments_of(errors_mm);
    expected_mm2 += rounding.mean_square_mm2 - rounding_variance_mm2(step_mm);
    slow_mm2 -= rounding.slow_mm2;
    // The errors by rounding of two samples are independent only if there is a limit between two steps
    // between the samples.
    independent = std::max(1.0, static_cast<double>(steps_in(errors_mm, step_mm)));
  }
  structure.excess_mm = std::sqrt(std::max(0.0, residual.mean_square_mm2 - expected_mm2));
  structure.slow_correlation = slow_mm2 / residual.mean_square_mm2;
  // For n readings of white noise, the mean autocorrelation over 25 lags has a standard deviation of
  // 1/sqrt(25 n). A correlation below 1 % of the variance does not count, even if it is significant. The mean
  // square of the residual is a second criterion: it must not exceed the noise variance by more than the
  // uncertainty of this variance.
  const double known_to = 4 * std::sqrt(6.0 / independent);
  structure.present =
      structure.slow_correlation > limits::negligible_share + 4 / std::sqrt(lags * independent) ||
      residual.mean_square_mm2 > expected_mm2 + noise_mm * noise_mm * (limits::negligible_share + known_to);
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
