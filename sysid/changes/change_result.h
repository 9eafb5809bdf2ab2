#pragma once
// States the fields of the diagnosis of a change. diagnosis.json contains the keys of every diagnosis and
// additional keys for a change. The page and the command show some of the fields in tables.

#include "base/result/result.h"
#include "sysid/changes/change.h"

namespace softgrip::sysid {

/// Returns the content of diagnosis.json.
[[nodiscard]] result::Fields fields_of(const ChangeDiagnosis& diagnosis);
/// Returns the fields of one quantity. The titled fields state its errors and changes.
[[nodiscard]] result::Fields fields_of(const JudgedChange& judged);

/// Returns the table of the causes: size, interval and share of the error.
[[nodiscard]] result::Table cause_table(const ChangeDiagnosis& diagnosis);
/// Returns the table of all tested causes: error reduction, tolerance, and reason of a rejection.
[[nodiscard]] result::Table tried_table(const JudgedChange& judged);
/// Returns the table of the RMS error of the baseline model in every run, without and with the causes.
[[nodiscard]] result::Table run_table(const JudgedChange& judged);
/// Returns the table of the causes that the logs cannot show, with a recording that would test each cause.
[[nodiscard]] result::Table not_tested_table(const JudgedChange& judged);

/// Returns the name of a run, and whether the run is healthy.
[[nodiscard]] std::string name_with_state(const RunLeft& run);

}  // namespace softgrip::sysid
