#pragma once
// diagnosis.json, a contract.

#include <nlohmann/json_fwd.hpp>

#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// The contract's JSON. `next_experiment` is null here; add_experiment() fills it in.
[[nodiscard]] nlohmann::ordered_json json_of(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
