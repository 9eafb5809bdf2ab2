#pragma once
// The tables of a diagnosis.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// "41.2 (33.6 to 46.6)": a share in per cent with its interval.
[[nodiscard]] std::string percent_range(const Spread& share);
/// Errors of the three models: all readings, blocks held out, logs held out.
[[nodiscard]] Table rmse_table(const Diagnosis& diagnosis);
/// Share and p-value of every condition, for the models that there are.
[[nodiscard]] Table condition_table(const Evidence& evidence, bool extended);
/// The candidates in the place of every cause, and beside all of them.
[[nodiscard]] std::vector<Table> candidate_tables(const Diagnosis& diagnosis);
/// Errors of every run that was left out of the fit.
[[nodiscard]] Table run_table(const Diagnosis& diagnosis);
/// Returns the causes of the first part: the named ones, and those that explain a part if the interval of
/// their error reduction excludes zero.
[[nodiscard]] std::vector<const NamedCause*> shown_causes(const Diagnosis& diagnosis);
/// The numbers of these causes with their intervals; of a cause with more than `most`, the first ones
/// of those that have an interval.
[[nodiscard]] Table cause_parameter_table(const Diagnosis& diagnosis, std::size_t most);
/// Parameters as given, recalibrated and extended.
[[nodiscard]] Table moved_table(const Diagnosis& diagnosis, const model::Model& given);

}  // namespace softgrip::sysid
