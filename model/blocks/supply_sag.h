#pragma once
// Models a valve whose output pressure decreases when the supply pressure decreases.

#include "model/block.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// Computes the pressure p = u (1 - coupling * loss) from the command u, with loss = max(0, 1 -
/// supply/nominal). The supply pressure is a member of Surroundings. A log for this block needs the column
/// supply_kpa.
template <class T>
class SupplySag {
 public:
  static constexpr BlockInfo info =
      block_info("supply_sag", Station::valve, Kind::pressure, Inverse::ignored, "Supply sag",
                 "The pressure decreases if the supply pressure falls below its nominal value.",
                 "p = u (1 - coupling max(0, 1 - supply/nominal))");
  static constexpr std::array parameters{
      parameter("coupling", "",
                "relative decrease of the pressure per relative decrease of the supply pressure",
                Typical{0.2}, Within{0.0, 1.0}, Scale{0.1}, Neutral{0.0}),
      parameter("nominal_kpa", "kPa",
                "nominal supply pressure; at the nominal and at every higher supply pressure, the block does "
                "not reduce the pressure",
                Typical{500.0}, Within{1.0, 10000.0}, Scale{50.0})};

  SupplySag(std::span<const T> values, const Preparation&) : coupling_(values[0]), nominal_kpa_(values[1]) {}

  void reset(const T& input) {
    gain_.reset(T(1.0));
    output_ = input;
  }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings& surroundings, Next&& next) {
    const T loss = 1.0 - surroundings.supply_kpa / nominal_kpa_;
    const Segment<T> out = gain_.step(in, value_of(loss) > 0.0 ? T(1.0 - coupling_ * loss) : T(1.0));
    output_ = out.end;
    next(out);
  }

 private:
  T coupling_;
  T nominal_kpa_;
  MovingGain<T> gain_;
  T output_{0.0};
};

}  // namespace softgrip::model
