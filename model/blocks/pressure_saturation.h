#pragma once
// Models a pressure that cannot reach the command, because the regulator or the supply limits the pressure.

#include "model/block.h"
#include "model/clip.h"

namespace softgrip::model {

/// Computes the pressure p = min(command, limit).
template <class T>
class PressureSaturation {
 public:
  static constexpr BlockInfo info =
      block_info("pressure_saturation", Station::valve, Kind::pressure, Inverse::bound, "Pressure saturation",
                 "The pressure never exceeds a limit, even if the commanded pressure exceeds this limit.",
                 "p = min(u, limit)");
  static constexpr std::array parameters{parameter("limit_kpa", "kPa",
                                                   "highest pressure that the valve reaches", Typical{100.0},
                                                   Within{0.0, 10000.0}, Scale{5.0}, Neutral{10000.0})};

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
