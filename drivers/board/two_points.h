#pragma once
// A straight line through two calibration points, the only kind of scaling. The slope may have either sign.

namespace softgrip::drivers {

/// The line through (x0, y0) and (x1, y1). For example, {4, 85, 20, 15} describes a sensor with 4-20 mA whose
/// reading decreases with the current. Requires x0 != x1, and y0 != y1 for x_at(). wiring_problems() and the
/// loaders check this.
struct TwoPoints {
  double x0 = 0;
  double y0 = 0;
  double x1 = 1;
  double y1 = 1;

  [[nodiscard]] constexpr double y_at(double x) const noexcept {
    return y0 + (x - x0) * ((y1 - y0) / (x1 - x0));
  }
  [[nodiscard]] constexpr double x_at(double y) const noexcept {
    return x0 + (y - y0) * ((x1 - x0) / (y1 - y0));
  }

  bool operator==(const TwoPoints&) const = default;
};

}  // namespace softgrip::drivers
