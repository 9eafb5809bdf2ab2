#pragma once
// Identification that chooses the structure; where the pressure was measured, in two stages joined at it.

#include <vector>

#include <tl/expected.hpp>

#include "sysid/identification/identify.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// Of `options`, `fixed`, `free`, `start_points`, `exponents`, `robust` and `profile` belong to the fit of a
/// given structure and are not used. With Drive::command and a pressure_kpa column in every log the finger is
/// identified from the measured pressure and the valve from command to measured pressure; the model has both,
/// the scores are the finger's. Fails with a sentence.
[[nodiscard]] tl::expected<Identification, std::string> identify_structure(
    const std::vector<Log>& logs, StructureQuestion question, const IdentifyOptions& options = {});

}  // namespace softgrip::sysid
