#pragma once
// Models a valve whose pressure is a constant multiple of the command.

#include "model/block.h"

namespace softgrip::model {

/// Computes the pressure p = scale u from the command u.
template <class T>
class PressureScale {
 public:
  static constexpr BlockInfo info =
      block_info("pressure_scale", Station::valve, Kind::pressure, Inverse::implicit, "Pressure scale",
                 "The pressure is a fixed multiple of the commanded pressure.", "p = scale u");
  static constexpr std::array parameters{parameter("scale", "", "pressure per commanded kPa", Typical{0.97},
                                                   Within{0.05, 20.0}, Scale{0.02}, Neutral{1.0})};

  PressureScale(std::span<const T> values, const Preparation&) : scale_(values[0]) {}

  void reset(const T& input) { output_ = scale_ * input; }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const T begin = output_;
    output_ = scale_ * in.end;
    next(Segment<T>{in.duration_s, begin, output_, scale_ * in.mean});
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    return end_kpa * scale_;
  }

 private:
  T scale_;
  T output_{0.0};
};

}  // namespace softgrip::model
