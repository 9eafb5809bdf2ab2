#pragma once
// Causes that give the same readings whatever the command.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {

/// The cause that bends the readings as `cause` does, at the other end of the load: stiffening and sensor
/// nonlinearity are both some function of displacement, and which function each is, nobody knows beforehand.
/// How well the one form of each that the catalogue has meets the data says nothing about where the bend is.
/// Empty where a block with memory stands between the two in `model` (Cause::parts_twins): a bend before it
/// and a bend behind it differ.
[[nodiscard]] std::optional<Cause> twin_of(const Cause& cause, const model::Model& model);

/// What the sensor may be instead of the actuator or the load, or the reverse, in the order in which it is
/// asked; empty for a cause that bends nothing.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Whether no command can tell the two apart, as far as `model` is right about the rest.
[[nodiscard]] bool are_twins(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
