#pragma once
// Identifies the structure and the parameters of a model. If the pressure was measured, the valve and the
// finger are identified separately.

#include <vector>

#include <tl/expected.hpp>

#include "sysid/identification/identify.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// Chooses a structure and identifies its parameters. If `drive` is Drive::command and each log has a
/// pressure_kpa column, valve and finger are identified separately. The finger is identified from the
/// measured pressure. The valve is identified from the command and the measured pressure. The model then
/// contains the valve and the finger, but the scores evaluate only the model of the finger. The members
/// `fixed`, `free`, `start_points`, `exponents`, `robust` and `profile` of `options` are ignored, because
/// they require a structure that the caller specifies. Returns an error sentence on failure.
[[nodiscard]] tl::expected<Identification, std::string> identify_structure(
    const std::vector<Log>& logs, StructureQuestion question, const IdentifyOptions& options = {});

}  // namespace softgrip::sysid
