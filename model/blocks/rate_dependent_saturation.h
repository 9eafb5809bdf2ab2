#pragma once
// Models a Bouc-Wen element that saturates earlier at high pressure rates than at low pressure rates.

#include "model/block.h"
#include "model/blocks/bouc_wen.h"

namespace softgrip::model {

/// Increases eta of the chain's Bouc-Wen element with the pressure rate, so that its hysteretic state
/// saturates earlier (see bouc_wen.h).
template <class T>
class RateDependentSaturation : public BoucWenPart<T> {
 public:
  static constexpr BlockInfo info = block_info(
      "rate_dependent_saturation", Station::actuator, Kind::element, Inverse::implicit,
      "Rate-dependent saturation",
      "The width of the hysteresis loop depends on the rate of pressure change, because bouc_wen saturates "
      "at a smaller amplitude if the rate of pressure change is high.",
      "bouc_wen: eta is replaced by eta (1 + saturation r/(r + rate)), settling r' = |p'| - r",
      Formerly{"rate_dependent_levelling"});
  static constexpr std::array parameters{
      parameter(
          "saturation", "",
          "largest relative increase of eta of bouc_wen, which is reached at high rates of pressure change",
          Typical{0.2}, Within{-0.9, 100.0}, Scale{0.1}, Neutral{0.0}, Formerly{"levelling"}),
      parameter("rate_kpa_per_s", "kPa/s",
                "rate of pressure change at which half of the largest increase is reached", Typical{20.0},
                Within{0.01, 1e5}, Scale{10.0}, IfLeftOut{20.0}),
      parameter("settling_s", "s", "time constant with which the rate of pressure change is averaged",
                Typical{0.05}, Within{1e-3, 100.0}, Scale{0.05}, IfLeftOut{0.05})};

  RateDependentSaturation(std::span<const T> values, const Preparation&)
      : rate_{values[0], values[1], values[2]} {}

  void shape(BoucWen<T>& hysteresis) const {
    if (!is_zero(rate_.share)) hysteresis.saturate_earlier(rate_);
  }

 private:
  BoucWenRate<T> rate_;
};

}  // namespace softgrip::model
