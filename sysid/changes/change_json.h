#pragma once
// Writes the diagnosis of a change as diagnosis.json: the keys of every diagnosis and those specific to a
// change.

#include <nlohmann/json_fwd.hpp>

#include "sysid/changes/change.h"

namespace softgrip::sysid {

[[nodiscard]] nlohmann::ordered_json json_of(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
