#pragma once
// A change as diagnosis.json: the keys that every diagnosis has, and what a change adds.

#include <nlohmann/json_fwd.hpp>

#include "sysid/changes/change.h"

namespace softgrip::sysid {

[[nodiscard]] nlohmann::ordered_json json_of(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
