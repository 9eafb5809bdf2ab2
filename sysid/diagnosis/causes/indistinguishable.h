#pragma once
// Finds causes that give the same readings for every command.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {

/// Returns the cause that has the same effect as `cause` at the other end of the load. Stiffening and sensor
/// nonlinearity are both unknown functions of displacement. Therefore the fit of each catalogue form does not
/// show where the nonlinearity is. Returns an empty value if `model` has a block with memory between the two
/// positions (Cause::makes_distinguishable). In that case the two causes give different readings.
[[nodiscard]] std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model);

/// Returns the sensor causes that may explain the effect instead of an actuator or load cause, or the
/// reverse. They are in the order in which they are tested. The list is empty for a cause without a static
/// nonlinearity.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Returns true if no command can separate the two causes. The result assumes that the rest of `model` is
/// correct.
[[nodiscard]] bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
