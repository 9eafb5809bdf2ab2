#pragma once
// The report of a change: what changed, by how much, what to do next, and what that rests on.

#include "sysid/changes/change.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// @param healthy  and `later`: the logs, for their hashes. @param given  the model that was given.
[[nodiscard]] Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                               const std::vector<Log>& later, const model::Model& given);

/// Every cause that was tried: its improvement, its tolerance, and why it was rejected.
[[nodiscard]] Table tried_table(const JudgedChange& judged);
/// Error of the base in every run, without and with the causes.
[[nodiscard]] Table run_table(const JudgedChange& judged);

}  // namespace softgrip::sysid
