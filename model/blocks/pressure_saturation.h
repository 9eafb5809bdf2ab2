#pragma once
// The pressure stops below the command: the regulator's or the supply's ceiling.

#include "model/block.h"
#include "model/clip.h"

namespace softgrip::model {

/// p = min(command, limit).
template <class T>
class PressureSaturation {
 public:
  static constexpr BlockInfo info{.id = "pressure_saturation",
                                  .station = Station::valve,
                                  .kind = Kind::pressure,
                                  .inverse = Inverse::bound,
                                  .title = "Pressure saturation",
                                  .meaning = "The pressure stops below the command.",
                                  .equation = "p = min(u, limit)"};
  static constexpr std::array parameters{ParameterSpec{.name = "limit_kpa",
                                                       .unit = "kPa",
                                                       .default_value = 100.0,
                                                       .lower = 0.0,
                                                       .upper = 10000.0,
                                                       .scale = 5.0,
                                                       .meaning = "highest pressure the valve reaches",
                                                       .neutral = 10000.0}};

  PressureSaturation(std::span<const T> values, const Preparation&) : limit_kpa_(values[0]) {}

  void reset(const T& input) { output_ = lesser(input, limit_kpa_); }
  [[nodiscard]] T output() const { return output_; }
  [[nodiscard]] const T& limit_kpa() const { return limit_kpa_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    clip_above(in, limit_kpa_, [&](const Segment<T>& s) {
      output_ = s.end;
      next(s);
    });
  }

 private:
  T limit_kpa_;
  T output_{0.0};
};

}  // namespace softgrip::model
