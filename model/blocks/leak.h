#pragma once
// Models the pressure drop between valve and finger. The flow through a leak at the finger causes this drop.
// The drop exists even while the pressure is constant.

#include "model/block.h"
#include "model/line_loss.h"

namespace softgrip::model {

/// Computes the pressure at the finger. LineLoss (model/line_loss.h) describes the equation.
template <class T>
class Leak {
 public:
  static constexpr BlockInfo info = block_info(
      "leak", Station::valve, Kind::pressure, Inverse::implicit, "Leak",
      "Because of the steady flow through a leak at the finger, the pressure drops along the air line.",
      "u = p (1 + share a / (p + a)), a = 101.325 kPa; u = p + share (p + a) / 4 above a");
  static constexpr std::array parameters{
      parameter("share", "",
                "fraction of a small pressure that is lost, equal to the square of the ratio of the "
                "conductances of leak and air line",
                Typical{0.03}, Within{0.0, 10.0}, Scale{0.02}, Neutral{0.0})};

  Leak(std::span<const T> values, const Preparation&) : loss_{values[0]} {}

  void reset(const T& input) { output_ = loss_.behind(input); }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const T begin = output_;
    output_ = loss_.behind(in.end);
    // The pressure at the finger is approximated by a straight line between its values at the two ends of the
    // segment. This approximation is sufficient, because within a sample the pressure is nonlinear in time
    // only as the result of a lag before this block.
    const T middle = (begin + output_) * 0.5;
    const double way = value_of(in.end) - value_of(in.begin);
    const T slope = way != 0.0 ? T((output_ - begin) / (in.end - in.begin)) : T(1.0);
    next(Segment<T>{in.duration_s, begin, output_, middle + slope * (in.mean - (in.begin + in.end) * 0.5)});
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    return loss_.behind(end_kpa);
  }

 private:
  LineLoss<T> loss_;
  T output_{0.0};
};

}  // namespace softgrip::model
