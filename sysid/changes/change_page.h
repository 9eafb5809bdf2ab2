#pragma once
// The report of a change: the change, its size, the next steps and the evidence.

#include "sysid/changes/change.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// @param healthy, later  the logs, for their hashes. @param given  the model in use.
[[nodiscard]] Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                               const std::vector<Log>& later, const model::Model& given);

/// Returns every tested cause: its improvement, its tolerance, and the reason if it was rejected.
[[nodiscard]] Table tried_table(const JudgedChange& judged);
/// Returns the error of the base in every run, without and with the causes.
[[nodiscard]] Table run_table(const JudgedChange& judged);

}  // namespace softgrip::sysid
