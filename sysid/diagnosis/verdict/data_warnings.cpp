#include "sysid/diagnosis/verdict/data_warnings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/identification/combinations.h"
#include "sysid/logs/doubts.h"

namespace softgrip::sysid {
namespace {

/// Which causes cannot be judged without a column.
void warn_of_columns(const Scales& scales, std::vector<std::string>& warnings) {
  for (const Column column : {Column::temperature_c, Column::supply_kpa}) {
    std::string ids;
    for (const Cause& cause : all_causes()) {
      if (cause.needs == column) ids += (ids.empty() ? "" : " and ") + std::string(cause.id);
    }
    if (!scales.has(column) && !ids.empty()) {
      warnings.push_back("no " + std::string(name_of(column)) + " column that varies: " + ids +
                         " cannot be judged");
    }
  }
}

}  // namespace

void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings) {
  if (const double ratio = beta_over_gain(model); ratio > 1)
    warnings.push_back("recalibrated, the model is unphysical: " + wrong_way_sentence(ratio));
}

bool contains_rest(const std::vector<Log>& logs) {
  constexpr double long_enough_s = 3, no_pressure_share = 0.02;
  const double largest_kpa = largest_command_kpa(logs);
  for (const Log& log : logs) {
    const std::vector<double>& u = log.pressure_command_kpa;
    double still_s = 0;
    for (std::size_t i = 1; i < u.size(); ++i) {
      const bool still = std::abs(u[i]) < no_pressure_share * largest_kpa && std::abs(u[i] - u[i - 1]) < 1e-6;
      still_s = still ? still_s + log.time_s[i] - log.time_s[i - 1] : 0;
      if (still_s > long_enough_s) return true;
    }
  }
  return false;
}

void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings) {
  for (std::string& doubt : doubts_among(logs)) warnings.push_back(std::move(doubt));
  warn_of_columns(scales, warnings);
  const bool measured =
      std::any_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
  if (!measured) {
    warnings.emplace_back(
        "commanded pressure only: what the valve does and what the actuator does are told apart by "
        "their nonlinearity alone");
  }
  std::vector<double> peaks;
  bool unloads = false;
  for (const Log& log : logs) {
    const std::vector<double>& u = log.pressure_command_kpa;
    double top = u.front();
    for (std::size_t i = 1; i < u.size(); ++i) {
      top = std::max(top, u[i]);
      unloads |= u[i] < top - 0.2 * scales.largest_kpa;
      if (i + 1 < u.size() && u[i] > u[i - 1] && u[i] >= u[i + 1]) peaks.push_back(u[i]);
    }
  }
  if (!unloads) warnings.emplace_back("unloading never seen: hysteresis cannot be judged");
  if (!contains_rest(logs))
    warnings.emplace_back("no rest at zero pressure: creep, softening and drift are hard to tell apart");
  if (!peaks.empty()) {
    const auto [low, high] = std::minmax_element(peaks.begin(), peaks.end());
    if (*high - *low < 0.05 * scales.largest_kpa) {
      warnings.emplace_back("one amplitude only: what depends on amplitude cannot be judged");
    }
  }
}

void warn_of_scale(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm,
                   std::vector<std::string>& warnings) {
  for (std::size_t k = 0; k < records.size(); ++k) {
    std::vector<double> predicted_mm = records[k].reading_mm;
    for (std::size_t i = 0; i < predicted_mm.size(); ++i) predicted_mm[i] -= residual_mm[k][i];
    if (std::string doubt = doubt_about_scale(records[k].name, predicted_mm, records[k].reading_mm);
        !doubt.empty())
      warnings.push_back(std::move(doubt));
  }
}

}  // namespace softgrip::sysid
