#pragma once
// Defines a straight line through two calibration points. Every scaling in a rig file or board file is a line
// of this kind. The slope may be positive or negative.

namespace softgrip::drivers {

/// The line through (x0, y0) and (x1, y1). For example, {4, 85, 20, 15} describes a sensor with 4-20 mA whose
/// reading decreases as the current increases. x0 and x1 must differ; x_at() also requires that y0 and y1
/// differ. wiring_problems() and the loaders of the files check these conditions.
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
