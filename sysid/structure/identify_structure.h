#pragma once
// Identification with a choice of the model structure. If the pressure was measured, valve and finger are
// identified separately.

#include <vector>

#include <tl/expected.hpp>

#include "sysid/identification/identify.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// Chooses a structure and identifies it. With Drive::command and a pressure_kpa column in each log, the
/// finger is identified from the measured pressure, and the valve from command to measured pressure. The
/// model contains both; the scores are those of the finger. The members `fixed`, `free`, `start_points`,
/// `exponents`, `robust` and `profile` of `options` are not used, because they concern a given structure. The
/// error is a sentence.
[[nodiscard]] tl::expected<Identification, std::string> identify_structure(
    const std::vector<Log>& logs, StructureQuestion question, const IdentifyOptions& options = {});

}  // namespace softgrip::sysid
