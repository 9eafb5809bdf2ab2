#pragma once
// Loading and unloading loops that differ in shape.

#include "model/block.h"
#include "model/exponential.h"

namespace softgrip::model {

/// An element that only unloading winds up: while the pressure falls, z approaches the memory length; while
/// it rises, z fades. Rate independent; nothing on the first loading. Bouc-Wen's own loop is point symmetric
/// in the limit, this one is not. Exact for any step size.
template <class T>
class AsymmetricHysteresis {
 public:
  static constexpr BlockInfo info{.id = "asymmetric_hysteresis",
                                  .station = Station::actuator,
                                  .kind = Kind::element,
                                  .inverse = Inverse::implicit,
                                  .title = "Asymmetric hysteresis",
                                  .meaning = "Loading and unloading loops differ in shape.",
                                  .equation =
                                      "y += gain z; falling: z' = |p'| (1 - z/memory); rising: "
                                      "z' = -|p'| z/memory"};
  static constexpr std::array parameters{
      ParameterSpec{.name = "gain_mm_per_kpa",
                    .unit = "mm/kPa",
                    .default_value = 0.02,
                    .lower = -10.0,
                    .upper = 10.0,
                    .scale = 0.02,
                    .meaning = "added per pressure at the start of unloading",
                    .neutral = 0.0},
      ParameterSpec{.name = "memory_kpa",
                    .unit = "kPa",
                    .default_value = 15.0,
                    .lower = 0.01,
                    .upper = 10000.0,
                    .scale = 5.0,
                    .meaning = "pressure over which a turn is forgotten"}};

  AsymmetricHysteresis(std::span<const T> values, const Preparation&)
      : gain_(values[0]), per_kpa_(1.0 / values[1]) {}

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
    // The cubic through both ends and their slopes.
    const T size = falling_ ? T(-change) : change;
    const T bow = size * per_kpa_ * (wound_kpa_ - before) * (1.0 / 12.0);
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

  // z after a monotone change: dz/d|p| = falling - z/memory.
  template <class U>
  [[nodiscard]] U moved(const U& change, bool falling) const {
    const U size = falling ? U(-change) : change;
    const U share = size * phi1(U(-(per_kpa_ * size)));  // memory (1 - exp(-size/memory))
    return falling ? U(wound_kpa_ + share * (1.0 - per_kpa_ * wound_kpa_))
                   : U(wound_kpa_ - share * (per_kpa_ * wound_kpa_));
  }

  T gain_;
  T per_kpa_;  // 1/memory
  bool falling_ = false;
  T wound_kpa_{0.0};  // z
  T pressure_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
