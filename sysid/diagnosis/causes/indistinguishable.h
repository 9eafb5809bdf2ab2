#pragma once
// Finds causes that no command can separate, because they give the same readings.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {

/// Returns the cause that has the same effect as `cause` on the other side of the load. For example,
/// stiffening and sensor nonlinearity are both unknown functions of the displacement, so a fit of their forms
/// does not show where the nonlinearity is. If `model` has a block with memory between the two positions
/// (Cause::makes_distinguishable), the two causes give different readings, and the result is nullopt.
[[nodiscard]] std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model);

/// Returns the causes that may explain the effect of `cause` instead, in the order of testing. For an
/// actuator or load cause, these are sensor causes. For a sensor cause, these are actuator and load causes.
/// The list is empty if `cause` has no static nonlinearity.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Returns true if no command can separate the two causes. The other blocks of `model` are assumed to be
/// correct.
[[nodiscard]] bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
