#pragma once
// Writes the report of a change: its cause, its size, the next steps and the evidence. diagnosis.json
// contains the keys of every diagnosis and additional keys for a change. The report page and the command
// `softgrip diagnose` show some of the fields in tables.

#include "base/result/result.h"
#include "sysid/changes/change.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns the content of diagnosis.json.
[[nodiscard]] result::Fields fields_of(const ChangeDiagnosis& diagnosis);
/// Returns the fields of one quantity, the displacement or the pressure. Fields with a title are shown in a
/// table: the errors and changes of the quantity.
[[nodiscard]] result::Fields fields_of(const JudgedChange& judged);

/// Returns the table of the causes: size, confidence interval, effect at full pressure, share of the error,
/// and alternatives.
[[nodiscard]] result::Table cause_table(const ChangeDiagnosis& diagnosis);
/// Returns the table of all tested causes: error reduction, tolerance, and reason of the rejection.
[[nodiscard]] result::Table tried_table(const JudgedChange& judged);
/// Returns the table of the RMS error of the baseline model in every run, without and with the causes.
[[nodiscard]] result::Table run_table(const JudgedChange& judged);
/// Returns the table of the causes that the logs cannot show. For each cause, the table describes a recording
/// that would test it.
[[nodiscard]] result::Table not_tested_table(const JudgedChange& judged);

/// Returns the name of a run. If the run is healthy, " (healthy)" follows the name.
[[nodiscard]] std::string name_with_state(const RunLeft& run);

/// Returns the page.
/// @param healthy, later  logs; the page lists their hashes.
/// @param given  model in use.
[[nodiscard]] Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                               const std::vector<Log>& later, const model::Model& given);

}  // namespace softgrip::sysid
