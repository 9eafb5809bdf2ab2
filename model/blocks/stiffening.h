#pragma once
// Models a gain that changes with the magnitude of the displacement; the sign of the displacement has no
// effect on the gain.

#include "model/block.h"
#include "model/static_map.h"

namespace softgrip::model {

/// Computes the displacement z from the displacement y of the elements: z = y / (1 + s |y|) for s >= 0, and z
/// = y (1 - s |y|) for s < 0, where s is the stiffening. The map is odd, monotone for every s, and smooth in
/// s at s = 0.
template <class T>
class Stiffening : public StaticMapBlock<Stiffening<T>, T> {
 public:
  static constexpr bool at_samples = true;
  static constexpr BlockInfo info =
      block_info("stiffening", Station::actuator, Kind::displacement, Inverse::implicit, "Stiffening",
                 "The gain of the finger depends on the displacement, equally for loading and unloading.",
                 "z = y / (1 + s |y|), for negative s: y (1 - s |y|)");
  static constexpr std::array parameters{
      parameter("stiffening_per_mm", "1/mm",
                "relative decrease of the secant gain per mm of displacement, at small displacements; the "
                "decrease of the tangent gain is twice as large",
                Typical{0.01}, Within{-1.0, 1.0}, Scale{0.005}, Neutral{0.0})};

  Stiffening(std::span<const T> values, const Preparation&) : stiffening_per_mm_(values[0]) {}

  template <class U>
  [[nodiscard]] U map(const U& y) const {
    const U magnitude = value_of(y) < 0.0 ? U(-y) : y;
    const U bent = stiffening_per_mm_ * magnitude;
    return value_of(stiffening_per_mm_) >= 0.0 ? U(y / (1.0 + bent)) : U(y * (1.0 - bent));
  }

 private:
  T stiffening_per_mm_;
};

}  // namespace softgrip::model
