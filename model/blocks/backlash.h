#pragma once
// Play between the actuator and the measured point.

#include "model/block.h"
#include "model/play.h"

namespace softgrip::model {

/// The measured point is dragged along with half the gap on either side.
template <class T>
class Backlash {
 public:
  static constexpr BlockInfo info{.id = "backlash",
                                  .station = Station::load,
                                  .kind = Kind::displacement,
                                  .inverse = Inverse::ignored,
                                  .title = "Backlash",
                                  .meaning = "Play between the actuator and the measured point.",
                                  .equation = "|y - z| <= gap/2, z moves only when it must"};
  static constexpr std::array parameters{ParameterSpec{.name = "gap_mm",
                                                       .unit = "mm",
                                                       .default_value = 0.3,
                                                       .lower = 0.0,
                                                       .upper = 100.0,
                                                       .scale = 0.1,
                                                       .meaning = "motion that is lost at a reversal",
                                                       .neutral = 0.0}};

  Backlash(std::span<const T> values, const Preparation&) : play_(T(values[0] * 0.5)) {}

  void reset(const T& input) { play_.reset(input); }
  [[nodiscard]] T output() const { return play_.output(); }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    play_.step(in, next);
  }

 private:
  Play<T> play_;
};

}  // namespace softgrip::model
