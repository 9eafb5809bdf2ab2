#pragma once
// Computes one step of the Bouc-Wen hysteresis with exponent 1, with all derivatives, for a monotonic change
// of the pressure p. The hysteretic state is h = beta g. The equation of g is dg/dp = 1 - k g, with k =
// +-(gamma + eta) while |g| grows and k = -+(gamma - eta) while |g| decreases. The upper sign is for a rising
// pressure, the lower sign for a falling one.

#include <cmath>

namespace softgrip::sysid {

/// f(x) = (1 - exp(-x)) / x and its derivative. The argument x is small for short pressure steps. For |x| <
/// 0.05, a polynomial with a relative error below 2e-16 is used.
struct Decay {
  double f;
  double slope;
};

[[nodiscard]] inline Decay decay(double x) {
  if (std::abs(x) < 0.05) {
    const double f =
        1 -
        x * (1.0 / 2 -
             x * (1.0 / 6 -
                  x * (1.0 / 24 - x * (1.0 / 120 - x * (1.0 / 720 - x * (1.0 / 5040 - x * (1.0 / 40320)))))));
    const double slope =
        -1.0 / 2 +
        x * (1.0 / 3 - x * (1.0 / 8 - x * (1.0 / 30 - x * (1.0 / 144 - x * (1.0 / 840 - x * (1.0 / 5760))))));
    return {f, slope};
  }
  const double e = std::expm1(-x);
  return {-e / x, ((1 + e) * (1 + x) - 1) / (x * x)};
}

/// g and its derivatives with respect to gamma + eta, gamma - eta, the time constant of the valve lag, and
/// the pressure peak before the start.
struct Hysteresis {
  double g = 0;
  double by_growing = 0;
  double by_shrinking = 0;
  double by_lag = 0;
  double by_peak = 0;
};

struct HysteresisRates {
  double growing;    ///< parameter sum gamma + eta [1/kPa]
  double shrinking;  ///< parameter difference gamma - eta [1/kPa]
};

/// Returns g after a monotonic change of the pressure, without derivatives.
[[nodiscard]] inline double stepped(double g, double change, const HysteresisRates& rates) {
  const double direction = change < 0 ? -1 : 1;
  const bool grows = g * direction >= 0;
  const double k = grows ? rates.growing * direction : -rates.shrinking * direction;
  const double end = g + change * (1 - k * g) * decay(k * change).f;
  if (grows || g * end >= 0) return end;
  const double to_zero = std::abs(k * g) < 1e-9 ? -g : std::log1p(-k * g) / k;
  const double rest = change - to_zero;
  return rest * decay(rates.growing * direction * rest).f;
}

/// Computes g and its derivatives after a monotonic change of the pressure.
/// @param change_by_lag,change_by_peak  derivatives of the pressure change.
inline void step(Hysteresis& h, double change, double change_by_lag, double change_by_peak,
                 const HysteresisRates& rates) {
  const double direction = change < 0 ? -1 : 1;
  const bool grows = h.g * direction >= 0;
  const double k = grows ? rates.growing * direction : -rates.shrinking * direction;
  const Decay d = decay(k * change);
  const double u = change * d.f;
  const double left = 1 - k * h.g;
  const double end = h.g + left * u;
  if (grows || h.g * end >= 0) {
    const double by_g = 1 - k * u;
    const double by_change = 1 - k * end;
    const double by_k = (left * change * change * d.slope - h.g * u) * direction;
    h.by_growing = by_g * h.by_growing + (grows ? by_k : 0);
    h.by_shrinking = by_g * h.by_shrinking - (grows ? 0 : by_k);
    h.by_lag = by_g * h.by_lag + by_change * change_by_lag;
    h.by_peak = by_g * h.by_peak + by_change * change_by_peak;
    h.g = end;
    return;
  }
  // After a pressure change of `to_zero`, g is zero. After this change, |g| grows.
  const bool straight = std::abs(k * h.g) < 1e-6;
  const double to_zero = straight ? -h.g * (1 + k * h.g / 2) : std::log1p(-k * h.g) / k;
  const double zero_by_g = -1 / left;
  const double zero_by_k = straight ? -h.g * h.g / 2 : -(to_zero + h.g / left) / k;
  const double rest = change - to_zero;
  const double k2 = rates.growing * direction;
  const Decay d2 = decay(k2 * rest);
  h.g = rest * d2.f;
  const double by_rest = 1 - k2 * h.g;
  h.by_growing = rest * rest * d2.slope * direction - by_rest * zero_by_g * h.by_growing;
  h.by_shrinking = by_rest * (zero_by_k * direction - zero_by_g * h.by_shrinking);
  h.by_lag = by_rest * (change_by_lag - zero_by_g * h.by_lag);
  h.by_peak = by_rest * (change_by_peak - zero_by_g * h.by_peak);
}

}  // namespace softgrip::sysid
