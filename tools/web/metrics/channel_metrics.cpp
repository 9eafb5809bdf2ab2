#include "tools/web/metrics/metrics.h"

#include <nlohmann/json.hpp>

#include "base/json.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using enum MetricText::Type;

constexpr double kpa_per_pa = 1e-3;
constexpr double mm_per_m = 1e3;

/// A quantity of the status, with its conversion to the base unit of Prometheus.
struct Quantity {
  const char* name;
  const char* key;
  double units_per_base_unit;  // factor by which the value in the status is divided to get the base unit
  const char* help;
};
constexpr Quantity quantities[] = {
    {"softgrip_reading_age_seconds", "age_s", 1, "Age of the displacement reading."},
    {"softgrip_displacement_meters", "displacement_mm", mm_per_m, "Measured displacement."},
    {"softgrip_reference_meters", "reference_mm", mm_per_m, "Commanded displacement."},
    {"softgrip_pressure_pascals", "pressure_kpa", kpa_per_pa,
     "Measured pressure, if the channel has a pressure sensor."},
    {"softgrip_temperature_celsius", "temperature_c", 1,
     "Measured temperature, if the channel has a temperature sensor."},
    {"softgrip_pressure_command_pascals", "command_kpa", kpa_per_pa, "Pressure command to the valve."},
    {"softgrip_squeeze_pascals", "squeeze_kpa", kpa_per_pa,
     "Gripping pressure: command minus free-motion pressure."},
    {"softgrip_model_residual_meters", "residual_mm", mm_per_m,
     "Measured displacement minus the free-motion displacement of the model in use."},
    {"softgrip_model_residual_rms_meters", "health_rms_mm", mm_per_m,
     "Root mean square of the model residual, from which the health state is determined."},
};

void add_per_channel(const Json& channels, MetricText& metrics, const auto& value_of) {
  for (const Json& channel : channels)
    metrics.sample({{"channel", json_text(channel, "name")}}, value_of(channel));
}

/// Returns the commanded pressure as a share of the available range. The range is from the rest pressure to
/// the pressure limit on the same side of rest as the command.
double pressure_use(const Json& channel) {
  const Json& limits = json_member(channel, "limits");
  const double rest_kpa = json_number(limits, "rest_kpa");
  const double away_kpa = json_number(channel, "command_kpa") - rest_kpa;
  const double end_kpa = json_number(limits, away_kpa < 0 ? "pressure_min_kpa" : "pressure_max_kpa");
  return away_kpa == 0 ? 0 : away_kpa / (end_kpa - rest_kpa);
}

void add_state_set(const Json& channels, MetricText& metrics, const char* key,
                   std::initializer_list<const char*> names) {
  for (const Json& channel : channels) {
    for (const char* name : names)
      metrics.sample({{"channel", json_text(channel, "name")}, {key, name}},
                     json_text(channel, key) == name ? 1 : 0);
  }
}

}  // namespace

void add_channel_metrics(const Json& channels, MetricText& metrics) {
  if (!channels.is_array()) return;
  for (const Quantity& quantity : quantities) {
    metrics.family(quantity.name, gauge, quantity.help);
    add_per_channel(channels, metrics, [&](const Json& channel) {
      return json_number(channel, quantity.key) / quantity.units_per_base_unit;
    });
  }
  metrics.family("softgrip_pressure_use_ratio", gauge,
                 "Distance of the command from the rest pressure as a share of the distance to the pressure "
                 "limit: 0 at rest, 1 at the limit.");
  add_per_channel(channels, metrics, pressure_use);
  metrics.family("softgrip_reading_valid", gauge, "1 while the displacement reading is valid.");
  add_per_channel(channels, metrics,
                  [](const Json& channel) { return json_text(channel, "validity") == "valid" ? 1.0 : 0.0; });
  metrics.family("softgrip_pressure_limited", gauge,
                 "1 while a limit of the rig or of the step restricts the pressure.");
  add_per_channel(channels, metrics,
                  [](const Json& channel) { return json_member(channel, "limit").is_string() ? 1.0 : 0.0; });
  metrics.family("softgrip_model_health", gauge,
                 "1 for the present health state of the model in use of the finger, 0 for the other states.");
  add_state_set(channels, metrics, "health", {"unknown", "healthy", "suspect", "unfit"});
}

}  // namespace softgrip::web
