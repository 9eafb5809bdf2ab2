#pragma once
// The width of a loop changes with the rate, beyond what creep does.

#include "model/blocks/rate_dependent_levelling.h"
#include "model/blocks/rate_dependent_width.h"
#include "model/blocks/relaxing_friction.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct RateDependentHysteresis {
  static constexpr std::string_view id = "rate_dependent_hysteresis";
  static constexpr std::string_view title = "Rate-dependent hysteresis";
  static constexpr Appears appears = Appears::moving;
  static constexpr WhenChanged when_changed{
      "fast motion costs more pressure than slow motion",
      {"Run the same stroke at three speeds and compare the loops.",
       "Look for rubbing, dried lubricant or a swollen seal, and record again."},
      {{{HealthNumber::loop_width, Moves::up}, {HealthNumber::lag, Moves::up}}}};

  /// A loop of its own that relaxes.
  struct Relaxing : FormOf<model::RelaxingFriction> {
    static Starts starts(const Scales& s) {
      const double gain = s.gain_mm_per_kpa();
      return every({{"gain_mm_per_kpa", {0.05 * gain, -0.05 * gain}},
                    {"width_kpa", {0.1 * s.largest_kpa, 0.5 * s.largest_kpa}},
                    {"time_constant_s", {0.3, 3.0}}});
    }
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {// A loop that no pressure of the data saturates is linear in the pressure: a viscous branch.
              {"width_kpa", 0.01 * s.largest_kpa, 0.5 * s.largest_kpa},
              // One that does not relax within the data's cycles does not know their rate.
              {"time_constant_s", s.sample_s, 0.1 * s.campaign_s}};
    }
  };

  /// The base's loop changes with a rate.
  template <template <class> class Block>
  struct Following : FormOf<Block> {
    using Form = FormOf<Block>;
    static typename Form::Starts sized(typename Form::Parameter size, const std::vector<double>& sizes,
                                       const Scales& s) {
      // The largest pressure in five seconds, in one, in a fifth.
      return Form::every({{"rate_kpa_per_s", {0.2 * s.largest_kpa, s.largest_kpa, 5 * s.largest_kpa}},
                          {"settling_s", {0.03, 0.2}},
                          {size, sizes}});
    }
    static typename Form::Bounds bounds(const Scales& s, const model::Model&) {
      return {// A loop that is wider by the same at all rates of the data is only wider.
              {"rate_kpa_per_s", 0.05 * s.largest_kpa, 20 * s.largest_kpa},
              // A longer memory describes the history of the pressure, not its rate.
              {"settling_s", 0.5 * s.sample_s, 0.5}};
    }
  };
  /// It grows.
  struct Growing : Following<model::RateDependentWidth> {
    static Starts starts(const Scales& s) { return sized("growth", {0.06, 0.2, 0.6}, s); }
  };
  /// It levels off sooner or later.
  struct Levelling : Following<model::RateDependentLevelling> {
    static Starts starts(const Scales& s) { return sized("levelling", {-0.3, 0.5, 3.0}, s); }
  };

  using Forms = List<Relaxing, Growing, Levelling>;
};

}  // namespace softgrip::sysid::causes
