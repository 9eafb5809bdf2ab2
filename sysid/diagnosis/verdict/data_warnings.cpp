#include "sysid/diagnosis/verdict/data_warnings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/identification/combinations.h"
#include "sysid/logs/excitation.h"
#include "sysid/logs/plausibility_warnings.h"

namespace softgrip::sysid {
namespace {

/// Adds a warning about causes that cannot be tested because a log column is missing or constant.
void warn_of_columns(const Scales& scales, std::vector<std::string>& warnings) {
  for (const Column column : {Column::temperature_c, Column::supply_kpa}) {
    std::string ids;
    for (const Cause& cause : all_causes()) {
      if (cause.needs == column) ids += (ids.empty() ? "" : " and ") + std::string(cause.id);
    }
    if (!scales.has(column) && !ids.empty()) {
      warnings.push_back("no " + std::string(name_of(column)) + " column that varies: " + ids +
                         " cannot be tested");
    }
  }
}

}  // namespace

void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings) {
  if (const double ratio = beta_over_gain(model); ratio > 1)
    warnings.push_back("the recalibrated model is unphysical: " + wrong_way_sentence(ratio));
}

void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings) {
  for (std::string& implausible : plausibility_warnings_among(logs))
    warnings.push_back(std::move(implausible));
  warn_of_columns(scales, warnings);
  const bool measured =
      std::any_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
  if (!measured) {
    warnings.emplace_back(
        "the logs contain the commanded pressure but no measured pressure, so only their nonlinearity "
        "separates the effects of the valve from the effects of the actuator");
  }
  for (const Excitation missing : missing_excitation(logs)) warnings.push_back(without(missing));
}

void warn_of_scale(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm,
                   std::vector<std::string>& warnings) {
  for (std::size_t k = 0; k < records.size(); ++k) {
    std::vector<double> predicted_mm = records[k].reading_mm;
    for (std::size_t i = 0; i < predicted_mm.size(); ++i) predicted_mm[i] -= residual_mm[k][i];
    if (std::string implausible =
            scale_warning(records[k].name, predicted_mm, records[k].reading_mm, records[k].output_unit);
        !implausible.empty())
      warnings.push_back(std::move(implausible));
  }
}

}  // namespace softgrip::sysid
