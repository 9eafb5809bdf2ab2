#pragma once
// Tables of a diagnosis.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns a percentage with its interval: "41.2 (33.6 to 46.6)".
[[nodiscard]] std::string percent_range(const Spread& share);
/// Returns the errors of the three models: for all readings, held-out blocks and held-out logs.
[[nodiscard]] Table rmse_table(const Diagnosis& diagnosis);
/// Returns share and p-value of every condition for each available model.
[[nodiscard]] Table condition_table(const Evidence& evidence, bool extended);
/// Returns the candidates for the position of every cause and for a further cause.
[[nodiscard]] std::vector<Table> candidate_tables(const Diagnosis& diagnosis);
/// Returns the errors of every run that was left out of the fit.
[[nodiscard]] Table run_table(const Diagnosis& diagnosis);
/// Returns the causes of the first part: the named ones, and those that explain a part if the interval of
/// their error reduction excludes zero.
[[nodiscard]] std::vector<const NamedCause*> shown_causes(const Diagnosis& diagnosis);
/// Returns the parameters of these causes with their intervals. If a cause has more than `most`, only the
/// first ones with an interval are shown.
[[nodiscard]] Table cause_parameter_table(const Diagnosis& diagnosis, std::size_t most);
/// Returns the parameters of the given, the recalibrated and the extended model.
[[nodiscard]] Table moved_table(const Diagnosis& diagnosis, const model::Model& given);

}  // namespace softgrip::sysid
