#pragma once
// Loop width that grows with rate beyond the viscous part.

#include "model/block.h"
#include "model/blocks/bouc_wen.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Three shapes of it, each with its own neutral value.
///
/// growth widens the loop of the chain's own Bouc-Wen element with the rate, levelling makes it level off
/// sooner (bouc_wen.h says how, and whose form it is). They have no output of their own and do nothing in a
/// chain without bouc_wen.
///
/// gain adds a friction that relaxes: z' = p' - z (|p'|/width + 1/tau), y -= gain z. Far faster than the
/// width per tau it is a hysteresis of that width, far slower a viscous branch whose loop shrinks with the
/// rate. Exact for straight pressure and any step size.
template <class T>
class RateDependentHysteresis {
 public:
  static constexpr BlockInfo info{.id = "rate_dependent_hysteresis",
                                  .station = Station::actuator,
                                  .kind = Kind::element,
                                  .inverse = Inverse::implicit,
                                  .title = "Rate-dependent hysteresis",
                                  .meaning = "Loop width grows with rate beyond the viscous part.",
                                  .equation =
                                      "y -= gain z, z' = p' - z (|p'|/width + 1/tau); bouc_wen: "
                                      "h counts h (1 + growth r/(r + rate)), eta counts eta (1 + levelling "
                                      "r/(r + rate)), settling r' = |p'| - r"};
  static constexpr std::array parameters{
      ParameterSpec{.name = "gain_mm_per_kpa",
                    .unit = "mm/kPa",
                    .default_value = 0.03,
                    .lower = -10.0,
                    .upper = 10.0,
                    .scale = 0.02,
                    .meaning = "held back per pressure after a turn",
                    .neutral = 0.0},
      ParameterSpec{.name = "width_kpa",
                    .unit = "kPa",
                    .default_value = 10.0,
                    .lower = 0.01,
                    .upper = 10000.0,
                    .scale = 5.0,
                    .meaning = "largest z, reached at high rates"},
      ParameterSpec{.name = "time_constant_s",
                    .unit = "s",
                    .default_value = 1.0,
                    .lower = 1e-3,
                    .upper = 1e4,
                    .scale = 0.5,
                    .meaning = "time over which z relaxes"},
      ParameterSpec{.name = "growth",
                    .unit = "",
                    .default_value = 0.2,
                    .lower = -0.9,
                    .upper = 100.0,
                    .scale = 0.1,
                    .meaning = "share by which the loop of bouc_wen is wider at "
                               "high rates",
                    .neutral = 0.0,
                    .if_left_out = 0.0},
      ParameterSpec{.name = "rate_kpa_per_s",
                    .unit = "kPa/s",
                    .default_value = 20.0,
                    .lower = 0.01,
                    .upper = 1e5,
                    .scale = 10.0,
                    .meaning = "rate at which it has grown by half of that",
                    .if_left_out = 20.0},
      ParameterSpec{.name = "settling_s",
                    .unit = "s",
                    .default_value = 0.05,
                    .lower = 1e-3,
                    .upper = 100.0,
                    .scale = 0.05,
                    .meaning = "time over which the rate is averaged",
                    .if_left_out = 0.05},
      ParameterSpec{.name = "levelling",
                    .unit = "",
                    .default_value = 0.2,
                    .lower = -0.9,
                    .upper = 100.0,
                    .scale = 0.1,
                    .meaning = "share by which eta of bouc_wen is larger at high rates",
                    .neutral = 0.0,
                    .if_left_out = 0.0}};

  RateDependentHysteresis(std::span<const T> values, const Preparation&)
      : gain_(values[0]),
        per_kpa_(1.0 / values[1]),
        per_s_(1.0 / values[2]),
        rate_{values[3], values[6], values[4], values[5]} {}

  /// Called once by the chain, which has made all its blocks by then.
  void shape(BoucWen<T>& hysteresis) const {
    if (!is_zero(rate_.growth) || !is_zero(rate_.levelling)) hysteresis.widen(rate_);
  }

  void reset(const T& input) {
    held_kpa_ = T(0.0);  // relaxed
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

  // dz/ds = change - decay z over s in [0, 1].
  template <class U>
  [[nodiscard]] U moved(const U& change, const U& decay) const {
    return held_kpa_ + (change - decay * held_kpa_) * phi1(U(-decay));
  }

  T gain_;
  T per_kpa_;  // 1/width
  T per_s_;    // 1/tau
  BoucWenRate<T> rate_;
  T held_kpa_{0.0};  // z
  T pressure_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
