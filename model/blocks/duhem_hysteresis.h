#pragma once
// Models hysteresis whose loading and unloading curves differ in shape. Each of the two directions has its
// own characteristic pressure.

#include "model/block.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Implements a Duhem operator with the state z [kPa]. While the pressure falls, z approaches the unloading
/// length. While the pressure rises, z decays over the loading length. Both lengths are pressure changes
/// [kPa]. z is rate independent, and zero on the first loading. If the two lengths are equal, the settled
/// loop is point symmetric, as the loop of Bouc-Wen is. If the lengths differ, the loop is not symmetric. The
/// solution is exact for any step size.
template <class T>
class DuhemHysteresis {
 public:
  static constexpr BlockInfo info =
      block_info("duhem_hysteresis", Station::actuator, Kind::element, Inverse::implicit, "Duhem hysteresis",
                 "Hysteresis with different shapes for loading and unloading. The hysteretic state z grows "
                 "during unloading and decays during loading.",
                 "y += gain z; falling: z' = |p'| (1 - z/unloading); rising: z' = -|p'| z/loading");
  static constexpr std::array parameters{
      parameter("gain_mm_per_kpa", "mm/kPa",
                "displacement per pressure change that the block adds at the start of unloading",
                Typical{0.02}, Within{-10.0, 10.0}, Scale{0.02}, Neutral{0.0}),
      parameter("unloading_kpa", "kPa", "pressure decrease over which the hysteretic state grows",
                Typical{20.0}, Within{0.01, 10000.0}, Scale{5.0}),
      parameter("loading_kpa", "kPa", "pressure increase over which the hysteretic state decays",
                Typical{5.0}, Within{0.01, 10000.0}, Scale{5.0})};

  DuhemHysteresis(std::span<const T> values, const Preparation&)
      : gain_(values[0]), unloading_per_kpa_(1.0 / values[1]), loading_per_kpa_(1.0 / values[2]) {}

  void reset(const T& input) {
    falling_ = value_of(input) < 0.0;
    wound_kpa_ = T(0.0);
    wound_kpa_ = moved(input, falling_);
    pressure_ = input;
    output_ = gain_ * wound_kpa_;
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    const T change = in.end - in.begin;
    falling_ = is_falling(change);
    const T before = wound_kpa_;
    wound_kpa_ = moved(change, falling_);
    pressure_ = in.end;
    output_ = gain_ * wound_kpa_;
    // Computes the mean of the state z over the segment as the mean of a cubic. This cubic has the values and
    // slopes of z at the ends of the segment.
    const T size = falling_ ? T(-change) : change;
    const T bow =
        size * (falling_ ? unloading_per_kpa_ : loading_per_kpa_) * (wound_kpa_ - before) * (1.0 / 12.0);
    return {in.duration_s, begin, output_, gain_ * ((before + wound_kpa_) * 0.5 + bow)};
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    const U change = end_kpa - pressure_;
    return gain_ * moved(change, is_falling(change));
  }

 private:
  template <class U>
  [[nodiscard]] bool is_falling(const U& change) const {
    const double value = value_of(change);
    return value < 0.0 || (value == 0.0 && falling_);
  }

  // Returns the state z of the operator after a monotone change of the pressure p: dz/d|p| = 1 - z/unloading
  // while p falls, and dz/d|p| = -z/loading while p rises.
  template <class U>
  [[nodiscard]] U moved(const U& change, bool falling) const {
    const T& per_kpa = falling ? unloading_per_kpa_ : loading_per_kpa_;
    const U size = falling ? U(-change) : change;
    return wound_kpa_ + size * phi1(U(-(per_kpa * size))) * ((falling ? 1.0 : 0.0) - per_kpa * wound_kpa_);
  }

  T gain_;
  T unloading_per_kpa_;  // 1 divided by the unloading length
  T loading_per_kpa_;
  bool falling_ = false;
  T wound_kpa_{0.0};  // the state z of the operator
  T pressure_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
