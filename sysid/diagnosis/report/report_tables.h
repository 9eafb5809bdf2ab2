#pragma once
// Creates the tables of a diagnosis report.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns a percentage with its interval as text: "41.2 (33.6 to 46.6)".
[[nodiscard]] std::string percent_range(const Spread& share);
/// Returns the errors of the given, the recalibrated and the extended model on all readings, on held-out
/// blocks and on held-out logs.
[[nodiscard]] Table rmse_table(const Diagnosis& diagnosis);
/// Returns a table with one row per condition. For each available model, it states the share of the residual
/// variance that the condition explains, and the p-value.
[[nodiscard]] Table condition_table(const Evidence& evidence, bool extended);
/// Returns one table per cause with the candidates that were tested as its replacement. The last table
/// contains the candidates that were tested as an additional cause.
[[nodiscard]] std::vector<Table> candidate_tables(const Diagnosis& diagnosis);
/// Returns the errors of the models on each run. The models were fitted to the other runs.
[[nodiscard]] Table run_table(const Diagnosis& diagnosis);
/// Returns the causes that the first part of the report shows. These are the named causes, and the partial
/// explanations whose error reduction is significantly above zero.
[[nodiscard]] std::vector<const NamedCause*> shown_causes(const Diagnosis& diagnosis);
/// Returns the parameters of the shown causes with their intervals. If a cause has more than `most`
/// parameters, the table lists only the first ones that have an interval.
[[nodiscard]] Table cause_parameter_table(const Diagnosis& diagnosis, std::size_t most);
/// Returns the parameters of the given, the recalibrated and the extended model.
[[nodiscard]] Table moved_table(const Diagnosis& diagnosis, const model::Model& given);

}  // namespace softgrip::sysid
