#pragma once
// Defines a cause: the width of the hysteresis loop depends on the rate of the pressure, beyond the
// dependence that creep causes.

#include "model/blocks/rate_dependent_saturation.h"
#include "model/blocks/rate_dependent_width.h"
#include "model/blocks/relaxing_friction.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct RateDependentHysteresis {
  static constexpr std::string_view id = "rate_dependent_hysteresis";
  static constexpr std::string_view title = "Rate-dependent hysteresis";
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "fast motions require more pressure than slow motions",
      {"Run one stroke at three speeds and compare the hysteresis loops.",
       "Check the finger for rubbing, dried lubricant or a swollen seal, then record again."},
      {{{HealthNumber::loop_width, Moves::up}, {HealthNumber::lag, Moves::up}}}};

  /// Form of the cause: an additional hysteresis element whose output relaxes with time.
  struct Relaxing : FormOf<model::RelaxingFriction> {
    static Starts starts(const Scales& s) {
      const double gain = s.gain_mm_per_kpa();
      return every({{"gain_mm_per_kpa", {0.05 * gain, -0.05 * gain}},
                    {"width_kpa", {0.1 * s.largest_kpa, 0.5 * s.largest_kpa}},
                    {"time_constant_s", s.times_s({0.3, 3.0})}});
    }
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {// If the width is larger than half of the pressure range, the element does not saturate and
              // acts like a linear viscous branch.
              {"width_kpa", 0.01 * s.largest_kpa, 0.5 * s.largest_kpa},
              // The time constant is at most 10 % of the measurement campaign, because the data cannot
              // determine a longer one.
              {"time_constant_s", s.sample_s, 0.1 * s.campaign_s}};
    }
  };

  /// Form of the cause: the parameters of the hysteresis in the base structure depend on the rate of the
  /// pressure.
  template <template <class> class Block>
  struct Following : FormOf<Block> {
    using Form = FormOf<Block>;
    static typename Form::Starts sized(typename Form::Parameter size, const std::vector<double>& sizes,
                                       const Scales& s) {
      // At these three rates, the pressure of a finger rises from 0 to its largest value in 5 s, in 1 s and
      // in 0.2 s.
      const double rate = s.largest_kpa / s.time_unit_s;
      return Form::every({{"rate_kpa_per_s", {0.2 * rate, rate, 5 * rate}},
                          {"settling_s", s.times_s({0.03, 0.2})},
                          {size, sizes}});
    }
    static typename Form::Bounds bounds(const Scales& s, const model::Model&) {
      return {// A change of the loop width that is equal at all rates in the data is not a dependence on the
              // rate.
              {"rate_kpa_per_s", 0.05 * s.largest_kpa / s.time_unit_s, 20 * s.largest_kpa / s.time_unit_s},
              // With a longer averaging time, the block would describe the history of the pressure and not
              // its rate.
              {"settling_s", 0.5 * s.sample_s, 0.5 * s.time_unit_s}};
    }
  };
  /// Form of the cause: the width of the hysteresis increases with the rate of the pressure.
  struct Growing : Following<model::RateDependentWidth> {
    static Starts starts(const Scales& s) { return sized("growth", {0.06, 0.2, 0.6}, s); }
  };
  /// Form of the cause: the saturation value of the hysteretic state depends on the rate of the pressure.
  struct Saturating : Following<model::RateDependentSaturation> {
    static Starts starts(const Scales& s) { return sized("saturation", {-0.3, 0.5, 3.0}, s); }
  };

  using Forms = List<Relaxing, Growing, Saturating>;
};

}  // namespace softgrip::sysid::causes
