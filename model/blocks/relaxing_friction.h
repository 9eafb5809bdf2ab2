#pragma once
// Models a hysteresis loop whose width grows with the pressure rate, because the friction force relaxes over
// time.

#include "model/block.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Implements Dahl's friction with relaxation: z' = p' - z (|p'|/width + 1/tau). z is the state, p the
/// pressure and tau the relaxation time. The block subtracts gain z from the displacement. At pressure rates
/// far above width/tau, the block acts as a hysteresis with this width. At rates far below width/tau, it acts
/// as a viscous branch, whose loop becomes smaller as the rate decreases. The solution is exact for straight
/// pressure and any step size.
template <class T>
class RelaxingFriction {
 public:
  static constexpr BlockInfo info = block_info(
      "relaxing_friction", Station::actuator, Kind::element, Inverse::implicit, "Relaxing friction",
      "The width of the hysteresis loop depends on the rate of pressure change, because the friction force "
      "relaxes with time.",
      "y -= gain z, z' = p' - z (|p'|/width + 1/tau)");
  static constexpr std::array parameters{
      parameter("gain_mm_per_kpa", "mm/kPa",
                "displacement per pressure by which friction reduces the motion after a reversal",
                Typical{0.03}, Within{-10.0, 10.0}, Scale{0.02}, Neutral{0.0}),
      parameter("width_kpa", "kPa", "largest value of z, which is reached at high rates of pressure change",
                Typical{10.0}, Within{0.01, 10000.0}, Scale{5.0}),
      parameter("time_constant_s", "s", "time constant with which z relaxes", Typical{1.0}, Within{1e-3, 1e4},
                Scale{0.5})};

  RelaxingFriction(std::span<const T> values, const Preparation&)
      : gain_(values[0]), per_kpa_(1.0 / values[1]), per_s_(1.0 / values[2]) {}

  void reset(const T& input) {
    held_kpa_ = T(0.0);  // at rest, the friction has relaxed completely
    pressure_ = input;
    output_ = T(0.0);
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    const T before = held_kpa_;
    const T change = in.end - in.begin;
    const T decay = size_of(change) * per_kpa_ + in.duration_s * per_s_;
    held_kpa_ = moved(change, decay);
    pressure_ = in.end;
    output_ = -gain_ * held_kpa_;
    const T bow = decay * (held_kpa_ - before) * (1.0 / 12.0);
    return {in.duration_s, begin, output_, -gain_ * ((before + held_kpa_) * 0.5 + bow)};
  }

  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const {
    const U change = end_kpa - pressure_;
    return -gain_ * moved(change, U(size_of(change) * per_kpa_ + duration_s * per_s_));
  }

 private:
  template <class U>
  static U size_of(const U& change) {
    return value_of(change) < 0.0 ? U(-change) : change;
  }

  // Returns the state z of the friction at the end of a segment. Solves dz/ds = change - decay z, where s
  // goes from 0 to 1 over the segment.
  template <class U>
  [[nodiscard]] U moved(const U& change, const U& decay) const {
    return held_kpa_ + (change - decay * held_kpa_) * phi1(U(-decay));
  }

  T gain_;
  T per_kpa_;        // 1 divided by the width of the hysteresis
  T per_s_;          // 1 divided by the relaxation time tau
  T held_kpa_{0.0};  // the state z of the friction
  T pressure_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
