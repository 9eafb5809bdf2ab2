#pragma once
// Finds causes that lead to the same readings for every command, so that no command can separate them.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {

/// Returns the cause in another component that leads to the same readings as `cause` for every command.
/// Example: stiffening of the finger and a nonlinear sensor are both unknown functions of the displacement,
/// so a fit cannot show which one is present. Returns nullopt if there is no such cause. Returns nullopt too
/// if `model` has a block with memory between the two components, because the readings then differ
/// (Cause::makes_distinguishable).
[[nodiscard]] std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model);

/// Returns the causes that may explain the effect of `cause` in its place, in the order of testing. An
/// actuator or load cause has sensor causes as counterparts. A sensor cause has actuator and load causes as
/// counterparts. The list is empty if `cause` is not a static nonlinearity.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Returns true if no command can separate the two causes. The function assumes that all other blocks of
/// `model` are correct.
[[nodiscard]] bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
