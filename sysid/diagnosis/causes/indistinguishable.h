#pragma once
// Finds causes that no command can separate, because they give the same readings.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {

/// Returns the cause in another component that gives the same readings as `cause` for every command. For
/// example, stiffening of the finger and a nonlinear sensor are both unknown functions of the displacement,
/// so a fit does not show which of the two is present. Returns nullopt if there is no such cause. Also
/// returns nullopt if `model` has a block with memory between the two components, because the readings then
/// differ (Cause::makes_distinguishable).
[[nodiscard]] std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model);

/// Returns the causes that may explain the effect of `cause` instead, in the order of testing. For an
/// actuator or load cause, these are sensor causes. For a sensor cause, these are actuator and load causes.
/// The list is empty if `cause` has no static nonlinearity.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Returns true if no command can separate the two causes. The other blocks of `model` are assumed to be
/// correct.
[[nodiscard]] bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
