#pragma once
// Writes the report of a change: its cause, its size, the next steps and the evidence.

#include "sysid/changes/change.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns the page.
/// @param healthy, later  logs; the page lists their hashes.
/// @param given  model in use.
[[nodiscard]] Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                               const std::vector<Log>& later, const model::Model& given);

}  // namespace softgrip::sysid
