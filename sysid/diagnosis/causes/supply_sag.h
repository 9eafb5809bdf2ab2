#pragma once
// Defines a cause: the pressure at the finger decreases when the supply pressure falls.

#include "model/blocks/supply_sag.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct SupplySag : FormOf<model::SupplySag> {
  static constexpr Column needs = Column::supply_kpa;
  static constexpr WhenChanged when_changed{
      "the pressure decreases when the supply pressure decreases",
      {"Read the supply gauge while the compressor refills.",
       "Connect other consumers to another line, or set the supply regulator higher, and record again."},
      {{{HealthNumber::pressure_loss, Moves::up}}},
      {SizedBy::Of::number, "relative pressure decrease at the finger per relative decrease of the supply",
       "%", "coupling", 100}};
  /// The nominal supply pressure is not fitted, because the parameter `coupling` is defined relative to it.
  static constexpr std::array<Parameter, 1> fitted{"coupling"};

  static Starts starts(const Scales& s) {
    return every({{"coupling", {0.1, 0.5}}, {"nominal_kpa", {s.largest_supply_kpa}}});
  }
};

}  // namespace softgrip::sysid::causes
