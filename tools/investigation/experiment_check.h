#pragma once
// Checks that a rig played the requested experiment and that the finger touched no object.

#include <optional>
#include <string>

#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

/// Returns a sentence if the command of the log differs from the waveform in duration, largest pressure or
/// total travel. Returns nullopt if it does not.
[[nodiscard]] std::optional<std::string> broken_promise(const sysid::Waveform& asked, const sysid::Log& log);

/// Returns a sentence if an object blocked the finger, else nullopt. The check uses pressures up to
/// `known_kpa`. A blocked finger moves as predicted in the lower part of its stroke, and far less than
/// predicted in the upper part.
/// @param predicted  prediction for the log by a model without contact
/// @param known_kpa  largest pressure of the logs to which the model was fitted
[[nodiscard]] std::optional<std::string> touched(const sysid::Validation& predicted, const sysid::Log& log,
                                                 double known_kpa);

}  // namespace softgrip::tools
