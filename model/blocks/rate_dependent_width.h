#pragma once
// Models a Bouc-Wen element whose hysteresis loop becomes wider as the pressure rate increases.

#include "model/block.h"
#include "model/blocks/bouc_wen.h"

namespace softgrip::model {

/// Makes the loop of the chain's Bouc-Wen element wider as the pressure rate increases. bouc_wen.h gives the
/// equation and its source.
template <class T>
class RateDependentWidth : public BoucWenPart<T> {
 public:
  static constexpr BlockInfo info = block_info(
      "rate_dependent_width", Station::actuator, Kind::element, Inverse::implicit, "Rate-dependent width",
      "The hysteresis loop of bouc_wen is wider at high rates of pressure change than at low rates.",
      "bouc_wen: h is replaced by h (1 + growth r/(r + rate)), settling r' = |p'| - r");
  static constexpr std::array parameters{
      parameter("growth", "",
                "largest relative increase of the loop width of bouc_wen, which is reached at high rates of "
                "pressure change",
                Typical{0.2}, Within{-0.9, 100.0}, Scale{0.1}, Neutral{0.0}),
      parameter("rate_kpa_per_s", "kPa/s",
                "rate of pressure change at which half of the largest increase is reached", Typical{20.0},
                Within{0.01, 1e5}, Scale{10.0}, IfLeftOut{20.0}),
      parameter("settling_s", "s", "time constant with which the rate of pressure change is averaged",
                Typical{0.05}, Within{1e-3, 100.0}, Scale{0.05}, IfLeftOut{0.05})};

  RateDependentWidth(std::span<const T> values, const Preparation&)
      : rate_{values[0], values[1], values[2]} {}

  void shape(BoucWen<T>& hysteresis) const {
    if (!is_zero(rate_.share)) hysteresis.widen(rate_);
  }

 private:
  BoucWenRate<T> rate_;
};

}  // namespace softgrip::model
