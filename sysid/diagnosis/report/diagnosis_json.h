#pragma once
// Writes diagnosis.json in the documented format.

#include <nlohmann/json_fwd.hpp>

#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// Returns the content of diagnosis.json. `next_experiment` is null until add_experiment() replaces it.
[[nodiscard]] nlohmann::ordered_json json_of(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
