#pragma once
// Defines a cause: the largest load up to the current time has made the finger softer (Mullins effect).

#include "model/blocks/pseudo_elastic_softening.h"
#include "model/blocks/stress_softening.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct StressSoftening {
  static constexpr std::array advice{Advice::record_temperature};
  static constexpr Appears appears = Appears::displaced;
  static constexpr WhenChanged when_changed{
      "the finger has softened after a large load",
      {"Check the events for a load above the usual load.",
       "Leave the finger vented overnight and record again. If the stiffness recovers, the cause is not "
       "wear."},
      {{{HealthNumber::gain, Moves::up}, {HealthNumber::loop_width, Moves::up}}}};

  /// Form of the cause: the softening is proportional to the largest pressure up to the current time.
  struct Proportional : FormOf<model::StressSoftening> {
    static constexpr std::array<Parameter, 1> fitted{"softening_per_kpa"};
    static bool holds(const model::BlockSpec& block) {
      return block.values[Parameter("saturation_per_kpa").index] == 0;
    }
    static Starts starts(const Scales& s) {
      return every({{"softening_per_kpa", {0.05 / s.largest_kpa, 0.3 / s.largest_kpa}}});
    }
  };
  /// Form of the cause: the softening saturates at large pressures.
  struct Saturating : FormOf<model::StressSoftening> {
    static Starts starts(const Scales& s) {
      return every({{"softening_per_kpa", {0.5 / s.largest_kpa}},
                    {"saturation_per_kpa", {1.0 / s.largest_kpa, 5.0 / s.largest_kpa}}});
    }
  };

  /// Form of the cause: the softening acts at pressures below the largest pressure up to the current time. It
  /// increases gradually when the pressure falls.
  struct PseudoElastic : FormOf<model::PseudoElasticSoftening> {
    static Starts starts(const Scales& s) {
      return every({{"softening_per_kpa", {0.05 / s.largest_kpa, 0.3 / s.largest_kpa}},
                    {"range_kpa", {0.1 * s.largest_kpa, 0.3 * s.largest_kpa}}});
    }
    /// The parameter `range_kpa` is between 2 % and 200 % of the largest pressure. With a smaller value, the
    /// softening is practically a step. With a larger value, the softening has no visible effect.
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {{"range_kpa", 0.02 * s.largest_kpa, 2 * s.largest_kpa}};
    }
  };

  using Forms = List<Proportional, Saturating, PseudoElastic>;
};

}  // namespace softgrip::sysid::causes
