#pragma once
// Finds causes that give the same readings for every command.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {

/// Returns the cause that has the same effect as `cause` on the other side of the load. For example,
/// stiffening and sensor nonlinearity are both unknown functions of the displacement, so a fit of their forms
/// does not show where the nonlinearity is. Returns an empty value if `model` has a block with memory between
/// the two positions (Cause::makes_distinguishable), because the two causes then give different readings.
[[nodiscard]] std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model);

/// Returns the sensor causes that may explain the effect of an actuator or load cause, or, for a sensor
/// cause, the actuator and load causes. They are sorted in the order of testing. The list is empty for a
/// cause without a static nonlinearity.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Returns true if no command can separate the two causes. Assumes that the rest of `model` is correct.
[[nodiscard]] bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
