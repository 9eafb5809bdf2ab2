#pragma once
// Gives the chain's Bouc-Wen element different parameters for loading and for unloading.

#include "model/block.h"
#include "model/blocks/bouc_wen.h"

namespace softgrip::model {

/// Makes the chain's Bouc-Wen element asymmetric. In one direction of the pressure, the element then
/// saturates faster, or follows the pressure more closely, than in the opposite direction. bouc_wen.h names
/// the source of the equation.
template <class T>
class AsymmetricBoucWen : public BoucWenPart<T> {
 public:
  static constexpr BlockInfo info = block_info(
      "asymmetric_bouc_wen", Station::actuator, Kind::element, Inverse::implicit, "Asymmetric Bouc-Wen",
      "The hysteresis loop of bouc_wen has different shapes for loading and unloading.",
      "bouc_wen: h' += beta_share beta |p'| - delta |h| |p'| - epsilon h p'");
  static constexpr std::array parameters{
      parameter("delta_per_kpa", "1/kPa",
                "value that is added to gamma of bouc_wen for loading and subtracted from gamma for "
                "unloading; at most eta of bouc_wen",
                Typical{0.01}, Within{-10.0, 10.0}, Scale{0.02}, Neutral{0.0}, IfLeftOut{0.0}),
      parameter("epsilon_per_kpa", "1/kPa",
                "value that is added to eta of bouc_wen for loading and subtracted from eta for unloading",
                Typical{0.01}, Within{-10.0, 10.0}, Scale{0.02}, Neutral{0.0}, IfLeftOut{0.0}),
      parameter("beta_share", "",
                "fraction of beta of bouc_wen that is added to beta for loading and subtracted from beta for "
                "unloading",
                Typical{0.1}, Within{-0.9, 0.9}, Scale{0.1}, Neutral{0.0}, IfLeftOut{0.0})};

  AsymmetricBoucWen(std::span<const T> values, const Preparation&) : skew_{values[0], values[1], values[2]} {}

  void shape(BoucWen<T>& hysteresis) const { hysteresis.skew(skew_); }

 private:
  BoucWenSkew<T> skew_;
};

}  // namespace softgrip::model
