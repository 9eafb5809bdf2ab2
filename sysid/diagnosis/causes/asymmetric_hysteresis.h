#pragma once
// The loading and unloading branches of a loop differ in shape.

#include "model/blocks/asymmetric_hysteresis.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct AsymmetricHysteresis {
  /// An element that takes another way up than down.
  struct OwnLoop : FormOf<model::AsymmetricHysteresis> {
    static constexpr std::array<Parameter, 3> fitted{"gain_mm_per_kpa", "unloading_kpa", "loading_kpa"};

    static bool holds(const model::BlockSpec& block) { return block.values[0] != 0; }
    static Starts starts(const Scales& s) {
      const double gain = s.gain_mm_per_kpa();
      return every({{"gain_mm_per_kpa", {-0.05 * gain, 0.05 * gain}},
                    {"unloading_kpa", {0.3 * s.largest_kpa}},
                    {"loading_kpa", {0.08 * s.largest_kpa, 0.3 * s.largest_kpa, s.largest_kpa}}});
    }
    /// Longer than all pressures, the way is a straight line.
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {{"unloading_kpa", 0.01 * s.largest_kpa, 3 * s.largest_kpa},
              {"loading_kpa", 0.01 * s.largest_kpa, 3 * s.largest_kpa}};
    }
  };

  /// The base's hysteresis, skewed.
  struct Skew : FormOf<model::AsymmetricHysteresis> {
    static constexpr std::array<Parameter, 3> fitted{"delta_per_kpa", "epsilon_per_kpa", "beta_share"};

    static bool holds(const model::BlockSpec& block) { return block.values[0] == 0; }
    static Starts starts(const Scales& s) {
      Starts starts;
      const double way_kpa = 0.3 * s.largest_kpa;
      // The state of the hysteresis levels off over some tenths of the pressures.
      for (const double delta : {-2.0, -0.8, -0.3, 0.3, 0.8, 2.0}) {
        const std::array<Value, 3> skews{{{"delta_per_kpa", delta / s.largest_kpa},
                                          {"epsilon_per_kpa", delta / s.largest_kpa},
                                          {"beta_share", 0.2 * delta}}};
        for (const Value& skew : skews)
          starts.push_back(start({{"unloading_kpa", way_kpa}, {"loading_kpa", way_kpa}, skew}));
      }
      return starts;
    }
  };

  using Forms = List<OwnLoop, Skew>;
};

}  // namespace softgrip::sysid::causes
