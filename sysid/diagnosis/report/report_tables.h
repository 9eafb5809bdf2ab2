#pragma once
// Builds the tables of a diagnosis.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns a percentage with its interval: "41.2 (33.6 to 46.6)".
[[nodiscard]] std::string percent_range(const Spread& share);
/// Returns the errors of the three models on all readings, on held-out blocks and on held-out logs.
[[nodiscard]] Table rmse_table(const Diagnosis& diagnosis);
/// Returns a table of the conditions: explained share of the residual variance and p-value for each available
/// model.
[[nodiscard]] Table condition_table(const Evidence& evidence, bool extended);
/// Returns one table per cause with the candidates that were tested in its place, and one with the candidates
/// that were tested as a further cause.
[[nodiscard]] std::vector<Table> candidate_tables(const Diagnosis& diagnosis);
/// Returns the errors of the models on each run, which was left out of the fit.
[[nodiscard]] Table run_table(const Diagnosis& diagnosis);
/// Returns the causes for the first part of the report: the named causes, and the partial explanations with
/// an interval of the error reduction that excludes zero.
[[nodiscard]] std::vector<const NamedCause*> shown_causes(const Diagnosis& diagnosis);
/// Returns the parameters of the shown causes with their intervals. If a cause has more than `most`
/// parameters, only the first ones with an interval are listed.
[[nodiscard]] Table cause_parameter_table(const Diagnosis& diagnosis, std::size_t most);
/// Returns the parameters of the given, the recalibrated and the extended model.
[[nodiscard]] Table moved_table(const Diagnosis& diagnosis, const model::Model& given);

}  // namespace softgrip::sysid
