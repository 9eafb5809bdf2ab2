#pragma once
// Computes the response of a first-order linear system over one segment. The response is exact if the input
// is a parabola in time.
//
// All blocks with a time constant use this file (valve lag, sensor lag, Kelvin-Voigt branches). With z =
// dt/tau, the solution is a combination of the phi functions of exponential integrators (Hochbruck and
// Ostermann, Acta Numerica 19, 2010, section 2.1): phi_k(-z) = integral over s in [0, 1] of exp(-z (1 - s))
// s^(k-1) / (k-1)!. The functions are computed accurately for z from 0 to infinity.

#include <array>
#include <cmath>
#include <cstddef>

#include "model/dual.h"
#include "model/segment.h"

namespace softgrip::model {

/// Returns phi_1(w) = (exp(w) - 1) / w. The result is accurate for positive, negative and zero w.
template <class T>
[[nodiscard]] inline T phi1(const T& w) {
  using std::expm1;
  const double magnitude = std::abs(value_of(w));
  if (magnitude < 0.004) {  // for |w| < 0.004, the first omitted term of the series is 0.004^5 / 720 =
                            // 1.4e-15
    const T w2 = w * w;
    return 1.0 + w * 0.5 + w2 * (1.0 / 6.0 + w * (1.0 / 24.0) + w2 * (1.0 / 120.0));
  }
  return expm1(w) / w;
}

/// Values of the functions phi_1 to phi_4 at the argument -z.
template <class T>
struct PhiFunctions {
  T phi1, phi2, phi3, phi4;
};

/// Returns phi_1(-z) to phi_4(-z) for z >= 0.
template <class T>
[[nodiscard]] inline PhiFunctions<T> phi_functions(const T& z) {
  using std::expm1;
  if (value_of(z) < 0.5) {  // uses 13 terms of the series of phi_4; relative to the first term 1/4!, the
                            // first omitted term is 0.5^13 / 17!, which is 8e-18
    constexpr std::array<double, 13> inverse_factorials{
        1.0 / 24,          1.0 / 120,           1.0 / 720,           1.0 / 5040,      1.0 / 40320,
        1.0 / 362880,      1.0 / 3628800,       1.0 / 39916800,      1.0 / 479001600, 1.0 / 6227020800,
        1.0 / 87178291200, 1.0 / 1307674368000, 1.0 / 20922789888000};
    T sum(inverse_factorials.back());
    for (std::size_t i = inverse_factorials.size() - 1; i-- > 0;) sum = inverse_factorials[i] - z * sum;
    const T phi3 = 1.0 / 6.0 - z * sum;
    const T phi2 = 0.5 - z * phi3;
    return {1.0 - z * phi2, phi2, phi3, sum};
  }
  const T inverse = 1.0 / z;
  const T phi1 = -expm1(-z) * inverse;
  const T phi2 = (1.0 - phi1) * inverse;
  const T phi3 = (0.5 - phi2) * inverse;
  return {phi1, phi2, phi3, (1.0 / 6.0 - phi3) * inverse};
}

/// Weights for the response of x' = gain_rate * u(t) - x / tau over one segment. The response is a weighted
/// sum of the old state and of the coefficients of the parabola u(s) = begin + (end - begin) s + bend s (1 -
/// s), s in [0, 1]. `gain_rate` is 1/tau for a lag, and 1/c for a Kelvin-Voigt branch with the damping c. For
/// `gain_rate` = 1/c, the response is also defined for a branch with stiffness 0.
template <class T>
struct ExponentialWeights {
  T loss;                              ///< share of the old state x0 that is lost in the new state: x1 = x0 -
                                       ///< loss x0 + ...
  T end_begin, end_rise, end_bend;     ///< weights of begin, end - begin and bend in the new state x1
  T mean_state;                        ///< weight of the old state x0 in the mean of x over the segment:
                                       ///< mean(x) = mean_state x0 + ...
  T mean_begin, mean_rise, mean_bend;  ///< weights of begin, end - begin and bend in the mean of x over the
                                       ///< segment

  /// @param duration_s  duration of the segment, >= 0.
  /// @param rate  1/tau, >= 0.
  /// @param gain_rate  as in the description of the class.
  static ExponentialWeights make(const T& duration_s, const T& rate, const T& gain_rate) {
    const T z = duration_s * rate;
    const PhiFunctions<T> f = phi_functions(z);
    const T g = duration_s * gain_rate;
    return {z * f.phi1, g * f.phi1, g * f.phi2, g * (f.phi2 - 2.0 * f.phi3),
            f.phi1,     g * f.phi2, g * f.phi3, g * (f.phi3 - 2.0 * f.phi4)};
  }

  [[nodiscard]] T end(const T& x0, const Segment<T>& u, const T& bend) const {
    return x0 - loss * x0 + end_begin * u.begin + end_rise * (u.end - u.begin) + end_bend * bend;
  }
  [[nodiscard]] T mean(const T& x0, const Segment<T>& u, const T& bend) const {
    return mean_state * x0 + mean_begin * u.begin + mean_rise * (u.end - u.begin) + mean_bend * bend;
  }
};

}  // namespace softgrip::model
