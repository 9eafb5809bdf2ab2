#include "sysid/diagnosis/cause.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "model/catalogue.h"

namespace softgrip::sysid {
namespace {

/// The base structure and the sensor's random error are no causes.
constexpr std::array<std::string_view, 4> not_causes{"bouc_wen", "kelvin_voigt", "sensor_noise",
                                                     "quantisation"};

using Values = std::vector<std::vector<double>>;

/// Every combination of the given values, one list per parameter.
Values grid(const std::vector<std::vector<double>>& axes) {
  Values all{{}};
  for (const std::vector<double>& axis : axes) {
    Values next;
    for (const std::vector<double>& part : all) {
      for (const double value : axis) {
        next.push_back(part);
        next.back().push_back(value);
      }
    }
    all = std::move(next);
  }
  return all;
}

Values starts_of_valve(std::string_view id, const Scales& s) {
  if (id == "transport_delay") return grid({{0.02, 0.1, 0.25, 0.5}});
  if (id == "valve_lag") return grid({{0.02, 0.1, 0.3, 0.6}});
  if (id == "valve_deadband")
    return grid({{0.01 * s.largest_kpa, 0.05 * s.largest_kpa, 0.15 * s.largest_kpa}});
  if (id == "pressure_saturation") {
    return grid({{0.97 * s.largest_kpa, 0.9 * s.largest_kpa, 0.75 * s.largest_kpa, 0.6 * s.largest_kpa}});
  }
  return grid({{0.1, 0.5}, {s.largest_supply_kpa}});  // supply_sag
}

Values starts_of_actuator(std::string_view id, const Scales& s) {
  const double gain = s.largest_kpa > 0 ? s.span_mm / s.largest_kpa : 1;
  if (id == "actuator_threshold")
    return grid({{0.02 * s.largest_kpa, 0.08 * s.largest_kpa, 0.2 * s.largest_kpa}});
  if (id == "stiffening") return grid({{-0.3 / s.span_mm, 0.1 / s.span_mm, 0.5 / s.span_mm}});
  if (id == "asymmetric_hysteresis") {
    return grid({{-0.05 * gain, 0.05 * gain}, {0.08 * s.largest_kpa, 0.3 * s.largest_kpa, s.largest_kpa}});
  }
  if (id == "rate_dependent_hysteresis") {
    return grid({{0.05 * gain, -0.05 * gain}, {0.1 * s.largest_kpa, 0.5 * s.largest_kpa}, {0.3, 3.0}});
  }
  if (id == "stress_softening") return grid({{0.05 / s.largest_kpa, 0.3 / s.largest_kpa}});
  if (id == "slow_creep") {
    return grid({{0.05 * gain, 0.2 * gain}, {0.15 * s.campaign_s, 0.5 * s.campaign_s, 2 * s.campaign_s}});
  }
  if (id == "thermal_gain") return grid({{-0.01, 0.01}});
  return grid({{-360 / s.campaign_s, 360 / s.campaign_s}});  // ageing: a tenth over the campaign
}

Values starts_of_load_and_sensor(std::string_view id, const Scales& s) {
  if (id == "contact") {
    return grid({{0.35 * s.span_mm, 0.55 * s.span_mm, 0.7 * s.span_mm, 0.85 * s.span_mm, 0.95 * s.span_mm},
                 {0.2, 1.5}});
  }
  if (id == "inertia") return grid({{0.05, 0.15, 0.4, 1.0}, {0.15, 0.5}});
  if (id == "backlash") return grid({{0.01 * s.span_mm, 0.05 * s.span_mm, 0.15 * s.span_mm}});
  if (id == "sensor_lag") return grid({{0.02, 0.1, 0.3, 0.6}});
  if (id == "sensor_drift") {
    const double rate = 3600 * 0.05 * s.span_mm / s.campaign_s;
    return grid({{-rate, rate}, {0.0}, {0.3 * s.campaign_s}});
  }
  if (id == "sensor_nonlinearity") return grid({{-0.02 * s.span_mm, 0.02 * s.span_mm}, {0.0}, {s.span_mm}});
  if (id == "sensor_saturation") {
    return grid({{-10000.0}, {0.97 * s.span_mm, 0.9 * s.span_mm, 0.75 * s.span_mm, 0.6 * s.span_mm}});
  }
  if (id == "periodic_disturbance") {
    Values starts;
    for (const Line& line : s.residual_lines)
      starts.push_back({line.sine_mm, line.cosine_mm, line.frequency_hz});
    return starts;
  }
  return {};  // outliers
}

}  // namespace

const std::vector<Cause>& all_causes() {
  static const std::vector<Cause> causes = [] {
    std::vector<Cause> list;
    const auto catalogue = model::catalogue();
    for (std::size_t type = 0; type < catalogue.size(); ++type) {
      const model::BlockInfo& info = catalogue[type].info;
      if (std::find(not_causes.begin(), not_causes.end(), info.id) != not_causes.end()) continue;
      list.push_back({type, info.id, info.station});
    }
    return list;
  }();
  return causes;
}

std::optional<Cause> find_cause(std::string_view id) {
  for (const Cause& cause : all_causes()) {
    if (cause.id == id) return cause;
  }
  return std::nullopt;
}

std::string unanswerable(const Cause& cause, const Scales& scales) {
  if (cause.id == "thermal_gain" && !scales.has_temperature)
    return "needs a temperature_c column that varies";
  if (cause.id == "supply_sag" && !scales.has_supply) return "needs a supply_kpa column that varies";
  if (cause.station == model::Station::valve && !scales.has_valve) {
    return "the measured pressure drives the model: what the valve does is in it";
  }
  return {};
}

std::vector<CauseStart> cause_starts(const Cause& cause, const Scales& scales) {
  Values values;
  switch (cause.station) {
    case model::Station::valve:
      values = starts_of_valve(cause.id, scales);
      break;
    case model::Station::actuator:
      values = starts_of_actuator(cause.id, scales);
      break;
    case model::Station::load:
    case model::Station::sensor:
      values = starts_of_load_and_sensor(cause.id, scales);
      break;
  }
  const model::Descriptor& descriptor = model::catalogue()[cause.type];
  std::vector<CauseStart> starts;
  for (std::vector<double>& v : values) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] = std::clamp(v[i], descriptor.spec(i).lower, descriptor.spec(i).upper);
    }
    starts.push_back({model::BlockSpec{cause.type, std::move(v)}});
  }
  return starts;
}

bool is_fitted(const Cause& cause, std::size_t index) {
  if (cause.id == "supply_sag") return index == 0;
  if (cause.id == "sensor_nonlinearity") return index < 2;
  if (cause.id == "sensor_saturation") return index == 1;
  return true;
}

}  // namespace softgrip::sysid
