#pragma once
// Defines a cause: the loading branch and the unloading branch of a hysteresis loop have different shapes.

#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/crescent_hysteresis.h"
#include "model/blocks/duhem_hysteresis.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct AsymmetricHysteresis {
  static constexpr std::string_view id = "asymmetric_hysteresis";
  static constexpr std::string_view title = "Asymmetric hysteresis";
  static constexpr WhenChanged when_changed{
      "loading and unloading curves have moved apart",
      {"Check if the finger or its guide rubs in one direction.",
       "Remove the load, then run the pressure up and down slowly three times."},
      {{{HealthNumber::loop_width, Moves::either_way}}}};

  /// Form of the cause: an additional hysteresis element, in which the loading curve and the unloading curve
  /// are different functions.
  struct OwnLoop : FormOf<model::DuhemHysteresis> {
    static Starts starts(const Scales& s) {
      const double gain = s.gain_mm_per_kpa();
      return every({{"gain_mm_per_kpa", {-0.05 * gain, 0.05 * gain}},
                    {"unloading_kpa", {0.3 * s.largest_kpa}},
                    {"loading_kpa", {0.08 * s.largest_kpa, 0.3 * s.largest_kpa, s.largest_kpa}}});
    }
    /// The characteristic pressures of both curves are at most 3 times the largest pressure. With larger
    /// characteristic pressures, the curves are practically straight lines.
    static Bounds bounds(const Scales& s, const model::Model&) {
      return {{"unloading_kpa", 0.01 * s.largest_kpa, 3 * s.largest_kpa},
              {"loading_kpa", 0.01 * s.largest_kpa, 3 * s.largest_kpa}};
    }
  };

  /// Form of the cause: the hysteresis of the base structure gets different loading and unloading branches.
  struct Skew : FormOf<model::AsymmetricBoucWen> {
    static Starts starts(const Scales& s) {
      Starts starts;
      // With these start values, the hysteretic state saturates after a pressure change of some tenths of the
      // pressure range.
      for (const double delta : {-2.0, -0.8, -0.3, 0.3, 0.8, 2.0}) {
        starts.push_back(start({{"delta_per_kpa", delta / s.largest_kpa}}));
        starts.push_back(start({{"epsilon_per_kpa", delta / s.largest_kpa}}));
        starts.push_back(start({{"beta_share", 0.2 * delta}}));
      }
      return starts;
    }
  };

  /// Form of the cause: a hysteresis loop that is wide at medium pressures and closes at the largest
  /// pressure.
  struct Crescent : FormOf<model::CrescentHysteresis> {
    static constexpr std::array<Parameter, 2> fitted{"gain_mm_per_kpa", "bend"};
    static Starts starts(const Scales& s) {
      const double gain = s.gain_mm_per_kpa();
      return every({{"gain_mm_per_kpa", {0.05 * gain}}, {"bend", {2, 6}}, {"range_kpa", {s.largest_kpa}}});
    }
    /// If `bend` is near zero, the element has no effect. If `bend` is large, the element is a step at the
    /// end of the pressure range. With a negative gain, the element would release more energy than it stores.
    /// A hysteresis loop that becomes narrower is described by the parameters of the base structure.
    static Bounds bounds(const Scales&, const model::Model&) {
      return {{"gain_mm_per_kpa", 0}, {"bend", 0.5, 30}};
    }
  };

  using Forms = List<OwnLoop, Skew, Crescent>;
};

}  // namespace softgrip::sysid::causes
