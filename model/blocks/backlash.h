#pragma once
// Models the play between the actuator and the measured point.

#include "model/block.h"
#include "model/play.h"

namespace softgrip::model {

/// Converts the motion of the actuator to the motion of the measured point. The measured point moves only
/// while the gap between actuator and measured point is closed. In the middle position, the gap on each side
/// is half of the backlash.
template <class T>
class Backlash : public OnePartBlock<T, Play<T>> {
 public:
  static constexpr BlockInfo info =
      block_info("backlash", Station::load, Kind::displacement, Inverse::ignored, "Backlash",
                 "Mechanical play between the actuator and the point whose displacement is measured.",
                 "|y - z| <= gap/2; z moves only to keep this condition");
  static constexpr std::array parameters{
      parameter("gap_mm", "mm", "motion of the actuator that is lost at a reversal", Typical{0.3},
                Within{0.0, 100.0}, Scale{0.1}, Neutral{0.0})};

  Backlash(std::span<const T> values, const Preparation&)
      : OnePartBlock<T, Play<T>>(Play<T>(T(values[0] * 0.5))) {}
};

}  // namespace softgrip::model
