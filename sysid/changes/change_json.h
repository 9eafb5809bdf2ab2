#pragma once
// Writes the diagnosis of a change as diagnosis.json. The file has the keys of every diagnosis and additional
// keys for a change.

#include <nlohmann/json_fwd.hpp>

#include "sysid/changes/change.h"

namespace softgrip::sysid {

[[nodiscard]] nlohmann::ordered_json json_of(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
