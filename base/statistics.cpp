#include "base/statistics.h"

#include <vector>

namespace softgrip {
namespace {

/// Computes the continued fraction of the incomplete beta function with Lentz's method (Abramowitz and Stegun
/// 26.5.8).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto kept_off_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / kept_off_zero(1 - (a + b) * x / (a + 1)), result = d;
  for (int m = 1; m <= 300; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    for (const double term : {even, odd}) {
      d = 1 / kept_off_zero(1 + term * d);
      c = kept_off_zero(1 + term / c);
      result *= c * d;
    }
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return result;
}

/// Returns the regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a
                                   : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

}  // namespace

double third_difference_noise(std::span<const double> values) {
  std::vector<double> sizes;
  for (std::size_t i = 3; i < values.size(); ++i)
    sizes.push_back(std::abs(values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3]));
  // The third difference has the weights 1, -3, 3 and -1, whose squares add up to 20. The median magnitude of
  // a standard normal variable is 0.6745.
  return median_of(std::span(sizes)) / (0.6745 * std::sqrt(20.0));
}

double t_quantile(double degrees_of_freedom) {
  // The square of a variable with Student's t distribution has an F distribution with one degree of freedom
  // in the numerator.
  constexpr double fewest = 1, most = 1e6;
  return std::sqrt(f_quantile(0.95, 1, std::min(std::max(fewest, degrees_of_freedom), most)));
}

double chi_square_quantile(double deviate, double degrees_of_freedom) {
  const double variance = 2 / (9 * degrees_of_freedom);
  const double root = 1 - variance + deviate * std::sqrt(variance);
  return degrees_of_freedom * root * root * root;
}

double f_quantile(double probability, double above, double below) {
  double lower = 0, upper = 1;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (lower + upper);
    (incomplete_beta(above / 2, below / 2, middle) < probability ? lower : upper) = middle;
  }
  const double x = 0.5 * (lower + upper);
  return below * x / (above * (1 - x));
}

}  // namespace softgrip
