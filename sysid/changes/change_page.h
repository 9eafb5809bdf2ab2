#pragma once
// The report of a change: what changed, by how much, what to do next, and what that rests on.

#include "sysid/changes/change.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// @param healthy  and `later`: the logs, for their hashes. @param given  the model that was given.
[[nodiscard]] Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                               const std::vector<Log>& later, const model::Model& given);

}  // namespace softgrip::sysid
