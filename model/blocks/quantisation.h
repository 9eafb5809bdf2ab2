#pragma once
// Models the finite resolution of the converter that digitises the reading.

#include <cmath>

#include "model/block.h"

namespace softgrip::model {

/// Rounds the reading to the nearest multiple of the step, but keeps the derivatives of the unrounded
/// reading. The derivative of the rounding itself is 0 almost everywhere, so a fit could not use it.
template <class T>
class Quantisation {
 public:
  static constexpr BlockInfo info = block_info(
      "quantisation", Station::sensor, Kind::reading, Inverse::ignored, "Quantisation",
      "The reading has the finite resolution of the analog-to-digital converter.", "z = step round(y/step)");
  static constexpr std::array parameters{parameter("step_mm", "mm", "size of one quantisation step",
                                                   Typical{0.01}, Within{0.0, 10.0}, Scale{0.01},
                                                   Neutral{0.0})};

  Quantisation(std::span<const T> values, const Preparation&) : step_mm_(value_of(values[0])) {}

  void reset(const T& input) { output_ = rounded(input); }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T&, const Surroundings&) {
    return output_ = rounded(displacement_mm);
  }

 private:
  [[nodiscard]] T rounded(const T& y) const {
    if (step_mm_ <= 0.0) return y;
    const double value = value_of(y);
    const double step = step_mm_ * std::round(value / step_mm_);
    if constexpr (std::is_arithmetic_v<T>) {
      return step;
    } else {
      return y + (step - value);
    }
  }

  double step_mm_;
  T output_{0.0};
};

}  // namespace softgrip::model
