#pragma once
// Statistics that several rooms need.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace softgrip {

[[nodiscard]] constexpr double square(double x) noexcept {
  return x * x;
}

/// The value that half of the others do not exceed; of an even count the upper of the two in the middle. 0 of
/// none. Brings `values` into another order.
template <class T>
[[nodiscard]] T median_of(std::span<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Sample-to-sample noise of a series: the median size of its third differences, as a standard deviation.
/// Smooth courses and single steps do not count. 0 of fewer than 4 values.
[[nodiscard]] double third_difference_noise(std::span<const double> values);

/// What a straight line through pairs of values needs, gathered pair by pair; those that are not finite are
/// passed over. Variances and covariance are times the count squared.
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
  /// Of y over x, by least squares; meaningless where x does not vary.
  [[nodiscard]] double slope() const { return covariance() / variance_x(); }
  /// 0 where either does not vary.
  [[nodiscard]] double correlation() const {
    const double product = variance_x() * (count * yy - y * y);
    return product > 0 ? covariance() / std::sqrt(product) : 0;
  }
};

/// Quantile of Student's t for a two-sided 95 % interval, by Cornish's and Fisher's expansion (Abramowitz and
/// Stegun 26.7.5); the error at 3 degrees of freedom is below 1 %.
[[nodiscard]] double t_quantile(double degrees_of_freedom);

}  // namespace softgrip
