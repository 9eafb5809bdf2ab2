#pragma once
// Names the components of a structure and removes them one at a time.

#include <array>
#include <string_view>

#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Components of a structure. Each is removed once to measure how much it reduces the error.
enum class Ingredient {
  hysteresis,
  play_operators,  ///< play operators; the Bouc-Wen element replaces them
  creep,
  slow_creep,
  pressure_dependent_creep,
  delay,
  lag,
  second_lag,
  rate_limit,
  latency,      ///< delay and lag together, because a delay can largely replace a lag, and a lag a delay
  regulator,    ///< regulator; a structure without it has a lag
  venting_lag,  ///< separate time constant for venting; a structure without it has one time constant
  /// Characteristic and envelopes together, because one of them can largely replace the other.
  characteristic,
  resonance,
  linear_modes,
  envelopes  ///< generalised play operators; a structure without them has ordinary play operators
};
inline constexpr std::array all_ingredients{Ingredient::hysteresis,
                                            Ingredient::play_operators,
                                            Ingredient::creep,
                                            Ingredient::slow_creep,
                                            Ingredient::pressure_dependent_creep,
                                            Ingredient::delay,
                                            Ingredient::lag,
                                            Ingredient::second_lag,
                                            Ingredient::rate_limit,
                                            Ingredient::latency,
                                            Ingredient::regulator,
                                            Ingredient::venting_lag,
                                            Ingredient::characteristic,
                                            Ingredient::resonance,
                                            Ingredient::linear_modes,
                                            Ingredient::envelopes};
[[nodiscard]] std::string_view name_of(Ingredient ingredient);

/// Returns the structure after removal of a component. If the structure does not contain the component, it is
/// returned unchanged.
[[nodiscard]] BaseStructure without(BaseStructure s, Ingredient ingredient);

/// Returns true if the structure contains the component. Ingredient::latency counts only if the structure has
/// both a delay and a lag. If it has one of them, the removal of this one is already another entry of an
/// ablation.
[[nodiscard]] bool has(const BaseStructure& s, Ingredient ingredient);

}  // namespace softgrip::sysid
