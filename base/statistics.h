#pragma once
// Computes medians, means, noise levels, regression lines and quantiles.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace softgrip {

[[nodiscard]] constexpr double square(double x) noexcept {
  return x * x;
}

/// Returns the median of the values. For an even number of values, this is the larger of the two middle
/// values. Returns 0 if `values` is empty. The function changes the order of `values`.
template <class T>
[[nodiscard]] T median_of(std::span<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns an estimate of the standard deviation of the white noise in samples. The estimate uses the median
/// magnitude of the third differences, on which smooth signals and single steps have almost no effect.
/// Returns 0 for fewer than 4 values.
[[nodiscard]] double third_difference_noise(std::span<const double> values);

/// Mean and standard deviation of values that are added one after the other (Welford, Technometrics 4, 1962).
struct Moments {
  std::size_t count = 0;
  double mean = 0;
  double squares = 0;  ///< sum of the squared deviations from the mean

  void add(double value) {
    ++count;
    const double step = value - mean;
    mean += step / static_cast<double>(count);
    squares += step * (value - mean);
  }
  /// Returns the standard deviation; 0 for fewer than 2 values.
  [[nodiscard]] double deviation() const {
    return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : 0;
  }
};

/// Sums from which the regression line through pairs (x, y) is computed. Pairs with a value that is not
/// finite are skipped. variance_x() returns the variance of x, and covariance() the covariance of x and y,
/// both multiplied by the square of the number of pairs.
struct PairSums {
  double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    count += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  [[nodiscard]] double variance_x() const { return count * xx - x * x; }
  [[nodiscard]] double covariance() const { return count * xy - x * y; }
  /// Returns the slope of the least-squares line of y over x. If all x are equal, the result is not a valid
  /// slope.
  [[nodiscard]] double slope() const { return covariance() / variance_x(); }
  /// Returns the correlation coefficient of x and y; 0 if all x or all y are equal.
  [[nodiscard]] double correlation() const {
    const double product = variance_x() * (count * yy - y * y);
    return product > 0 ? covariance() / std::sqrt(product) : 0;
  }
};

/// Returns the 97.5 % quantile of Student's t distribution. The standard error times this quantile is half of
/// the width of a 95 % interval. Fewer than 1 degree of freedom are treated as 1, and more than 1e6 as 1e6.
[[nodiscard]] double t_quantile(double degrees_of_freedom);

/// Returns a quantile of the chi-square distribution (Wilson and Hilferty, Proc. Natl. Acad. Sci. 17, 1931).
/// The error is below 4 % for a deviate between 1.5 and 3.5.
/// @param deviate  quantile of the standard normal distribution with the same probability.
/// @param degrees_of_freedom  at least 1.
[[nodiscard]] double chi_square_quantile(double deviate, double degrees_of_freedom);

/// Returns a quantile of the F distribution (Abramowitz and Stegun 26.6). A random value with this
/// distribution is below the result with the given probability.
/// @param probability  in (0, 1).
/// @param above, below  degrees of freedom of numerator and denominator, >= 1.
[[nodiscard]] double f_quantile(double probability, double above, double below);

}  // namespace softgrip
