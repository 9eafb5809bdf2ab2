#pragma once
// Models a nonlinear relation between the sum of the elements' outputs and the displacement.

#include "model/block.h"
#include "model/characteristic_map.h"
#include "model/static_map.h"

namespace softgrip::model {

/// Maps the sum of the elements' outputs to the displacement. CharacteristicMap (model/characteristic_map.h)
/// describes the equation. The map is monotone for every value of the curvature.
template <class T>
class Characteristic : public StaticMapBlock<Characteristic<T>, T> {
 public:
  static constexpr BlockInfo info = block_info(
      "characteristic", Station::actuator, Kind::displacement, Inverse::implicit, "Characteristic",
      "The displacement is a nonlinear function of the summed displacement of all blocks that "
      "compute a displacement. Loading and unloading have the same nonlinear function.",
      "z = span (exp(a y/span) - 1) / (exp(a) - 1) for y from 0 to span; straight lines outside this range");
  static constexpr std::array parameters{
      parameter("curvature", "", "parameter a; if a is above 0, the finger is softer at larger displacements",
                Typical{0.5}, Within{-4.0, 4.0}, Scale{0.2}, Neutral{0.0}),
      parameter("span_mm", "mm",
                "displacement at which the nonlinear range ends: the span of the logged displacements",
                Typical{20.0}, Within{1e-6, 1e6}, Scale{1.0}, Placed{})};

  Characteristic(std::span<const T> values, const Preparation&) : map_{values[0], values[1]} {}

  template <class U>
  [[nodiscard]] U map(const U& y) const {
    return map_.value(y);
  }

 private:
  CharacteristicMap<T> map_;
};

}  // namespace softgrip::model
