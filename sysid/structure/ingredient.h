#pragma once
// Names the components of a structure and removes them one at a time.

#include <array>
#include <string_view>

#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Components of a structure. An ablation removes each component once, to measure the error reduction by this
/// component.
enum class Ingredient {
  hysteresis,
  play_operators,  ///< play operators; after their removal, the structure has the Bouc-Wen element
  creep,
  slow_creep,
  pressure_dependent_creep,
  delay,
  lag,
  second_lag,
  rate_limit,
  latency,      ///< delay, lags and rate limit together, because delay and lag can largely replace each other
  regulator,    ///< regulator; after its removal, the structure has a lag
  venting_lag,  ///< separate time constant for venting; after its removal, the lag has one time constant
  /// Characteristic and envelopes together, because each of them can largely replace the other.
  characteristic,
  resonance,
  linear_modes,
  envelopes  ///< nonlinear envelopes of the play operators; after their removal, the operators are ordinary
             ///< ones
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

/// Returns a copy of the structure without this component. If the structure does not contain the component,
/// returns the structure unchanged.
[[nodiscard]] BaseStructure without(BaseStructure s, Ingredient ingredient);

/// Returns true if the structure contains the component. For Ingredient::latency, returns true only if the
/// structure has both a delay and a lag. With only one of them, `latency` would repeat the entry for this
/// component.
[[nodiscard]] bool has(const BaseStructure& s, Ingredient ingredient);

}  // namespace softgrip::sysid
