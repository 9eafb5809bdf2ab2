#pragma once
// Whether a rig played what an experiment asked for, on a finger that touched nothing.

#include <optional>
#include <string>

#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

/// A sentence where the log's command is not the waveform: another length, another largest pressure, another
/// distance travelled.
[[nodiscard]] std::optional<std::string> broken_promise(const sysid::Waveform& asked, const sysid::Log& log);

/// A sentence where the finger was stopped on its way: within the pressures that the model was fitted to, it
/// moves as the model says in the lower part of its stroke and far less in the upper part.
/// @param predicted  the log, predicted by a model that knows no contact
/// @param known_kpa  the largest pressure that the model was fitted to
[[nodiscard]] std::optional<std::string> touched(const sysid::Validation& predicted, const sysid::Log& log,
                                                 double known_kpa);

}  // namespace softgrip::tools
