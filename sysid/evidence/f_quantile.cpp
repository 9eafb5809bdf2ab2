#include "sysid/evidence/f_quantile.h"

#include <cmath>
#include <initializer_list>

namespace softgrip::sysid {
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

double f_quantile(double probability, double above, double below) {
  double lower = 0, upper = 1;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (lower + upper);
    (incomplete_beta(above / 2, below / 2, middle) < probability ? lower : upper) = middle;
  }
  const double x = 0.5 * (lower + upper);
  return below * x / (above * (1 - x));
}

}  // namespace softgrip::sysid
