#include "sysid/diagnosis/causes/cause.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "model/catalogue.h"
#include "sysid/fitting/trajectory.h"

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

/// Bands of a valve that sticks and jumps. The misfit has a minimum wherever the staircase gains or loses a
/// step on the way to the largest pressure: starts a step apart leave none out, down to bands of 1/60 of it.
/// Smaller ones differ by little more than their size.
std::vector<double> jumping_bands_kpa(const Scales& s) {
  std::vector<double> bands;
  for (int steps = 5; steps < 60; ++steps) bands.push_back(s.largest_kpa / steps);
  for (int i = 0; i < 19; ++i) bands.push_back(s.largest_kpa / (60 * std::pow(1.1, i)));
  return bands;
}

Values starts_of_valve(std::string_view id, const Scales& s) {
  if (id == "transport_delay") return grid({{0.02, 0.1, 0.25, 0.5}});
  if (id == "valve_lag") return grid({{0.02, 0.1, 0.3, 0.6}});
  if (id == "valve_deadband") {
    Values values = grid({{0.01 * s.largest_kpa, 0.05 * s.largest_kpa, 0.15 * s.largest_kpa}, {0.0}});
    for (const double band : jumping_bands_kpa(s)) values.push_back({band, 1.0});
    return values;
  }
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
    Values values = grid({{-0.05 * gain, 0.05 * gain},
                          {0.3 * s.largest_kpa},
                          {0.08 * s.largest_kpa, 0.3 * s.largest_kpa, s.largest_kpa},
                          {0.0},
                          {0.0},
                          {0.0}});
    // The state of the hysteresis levels off over some tenths of the pressures.
    for (const double delta : {-2.0, -0.8, -0.3, 0.3, 0.8, 2.0}) {
      values.push_back({0.0, 0.3 * s.largest_kpa, 0.3 * s.largest_kpa, delta / s.largest_kpa, 0.0, 0.0});
      values.push_back({0.0, 0.3 * s.largest_kpa, 0.3 * s.largest_kpa, 0.0, delta / s.largest_kpa, 0.0});
      values.push_back({0.0, 0.3 * s.largest_kpa, 0.3 * s.largest_kpa, 0.0, 0.0, 0.2 * delta});
    }
    return values;
  }
  if (id == "rate_dependent_hysteresis") {
    Values values = grid({{0.05 * gain, -0.05 * gain},
                          {0.1 * s.largest_kpa, 0.5 * s.largest_kpa},
                          {0.3, 3.0},
                          {0.0},
                          {s.largest_kpa},
                          {0.05},
                          {0.0}});
    for (const double rate : {0.2, 1.0, 5.0}) {  // the largest pressure in five seconds, in one, in a fifth
      for (const double settling_s : {0.03, 0.2}) {
        for (const double growth : {0.06, 0.2, 0.6}) {
          values.push_back({0.0, 0.3 * s.largest_kpa, 1.0, growth, rate * s.largest_kpa, settling_s, 0.0});
        }
        for (const double levelling : {-0.3, 0.5, 3.0}) {
          values.push_back({0.0, 0.3 * s.largest_kpa, 1.0, 0.0, rate * s.largest_kpa, settling_s, levelling});
        }
      }
    }
    return values;
  }
  if (id == "stress_softening") {
    Values values = grid({{0.05 / s.largest_kpa, 0.3 / s.largest_kpa}, {0.0}});
    for (const double levelling : {1.0, 5.0})
      values.push_back({0.5 / s.largest_kpa, levelling / s.largest_kpa});
    return values;
  }
  if (id == "slow_creep") {
    return grid({{0.05 * gain, 0.2 * gain}, {0.15 * s.campaign_s, 0.5 * s.campaign_s, 2 * s.campaign_s}});
  }
  if (id == "thermal_gain") return grid({{-0.01, 0.01}});
  // Ageing: a tenth over the campaign.
  const double way_m = 0.1 * s.campaign_s * s.span_mm * 1e-3;
  Values values = grid({{-360 / s.campaign_s, 360 / s.campaign_s}, {0.0}, {0.2 * s.campaign_s}, {0.0}});
  for (const double size : {-0.1, 0.1}) {
    for (const double campaigns : {0.07, 0.2, 0.5})
      values.push_back({0.0, size, campaigns * s.campaign_s, 0.0});
    values.push_back({0.0, 0.0, 0.2 * s.campaign_s, size / way_m});
  }
  return values;
}

/// Sine and cosine parts of waves of every phase, small and not so small [mm].
std::vector<std::pair<double, double>> waves(const Scales& s) {
  std::vector<std::pair<double, double>> list;
  for (const double size_mm : {0.004 * s.span_mm, 0.016 * s.span_mm}) {
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double angle = eighth * std::numbers::pi / 4;
      list.emplace_back(size_mm * std::cos(angle), size_mm * std::sin(angle));
    }
  }
  return list;
}

/// Knots of a zero that wanders as it likes: closer together, they would follow the loops.
std::size_t knots_of(const Scales& s) {
  constexpr double closest_s = 12;
  return static_cast<std::size_t>(std::clamp(s.campaign_s / closest_s, 2.0, 16.0));
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
    Values values = grid({{-rate, rate}, {0.0}, {0.3 * s.campaign_s}, {0.0}, {0.0}, {s.campaign_s}, {30.0}});
    for (const double campaigns : {0.15, 0.25, 0.4, 0.65, 1.0, 1.7}) {
      for (const auto& [sine, cosine] : waves(s)) {
        values.push_back({0.0, 0.0, 0.3 * s.campaign_s, sine, cosine, campaigns * s.campaign_s, 30.0});
      }
    }
    values.push_back({0.0, 0.0, 0.3 * s.campaign_s, 0.0, 0.0, s.campaign_s,
                      s.campaign_s / static_cast<double>(knots_of(s))});
    values.back().resize(values.back().size() + knots_of(s), 0.0);
    return values;
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

bool has_free_form(const Cause& cause, const model::BlockSpec& block) {
  return block.values.size() > model::catalogue()[cause.type].parameters.size();
}

bool is_fitted(const Cause& cause, const model::BlockSpec& block, std::size_t index) {
  const std::vector<double>& v = block.values;
  if (cause.id == "supply_sag") return index == 0;
  if (cause.id == "sensor_nonlinearity") return index < 2;
  if (cause.id == "sensor_saturation") return index == 1;
  if (cause.id == "asymmetric_hysteresis") return (index < 3) == (v[0] != 0);
  if (cause.id == "rate_dependent_hysteresis") {
    if (index == 4 || index == 5) return v[3] != 0 || v[6] != 0;
    return index < 3 ? v[0] != 0 : v[index] != 0;
  }
  if (cause.id == "stress_softening") return index == 0 || v[1] != 0;
  if (cause.id == "ageing") return index == 2 ? v[1] != 0 : v[index] != 0;
  if (cause.id == "sensor_drift") {
    const std::size_t singles = model::catalogue()[cause.type].parameters.size();
    if (has_free_form(cause, block)) return index >= singles;
    return index < 3 ? v[0] != 0 || v[1] != 0 : index < 6 && (v[3] != 0 || v[4] != 0);
  }
  return true;
}

Scales scales_of(const std::vector<Record>& records) {
  const auto varies = [](const std::vector<double>& column) {
    if (column.empty()) return false;
    const auto [low, high] = std::minmax_element(column.begin(), column.end());
    return *high - *low > 1e-6 * std::max(1.0, std::abs(*high));
  };
  Scales s;
  s.sample_s = std::numeric_limits<double>::infinity();
  for (const Record& record : records) {
    s.span_mm = std::max(s.span_mm, record.span_mm);
    s.largest_kpa = std::max(s.largest_kpa, record.largest_kpa);
    s.campaign_s += record.length_s();
    s.sample_s = std::min(s.sample_s, record.mean_interval_s());
    s.has_temperature |= varies(record.temperature_c);
    s.has_supply |= varies(record.supply_kpa);
    for (const double supply : record.supply_kpa)
      s.largest_supply_kpa = std::max(s.largest_supply_kpa, supply);
  }
  return s;
}

Range fit_range(const Cause& cause, std::size_t index, const model::Model& model, const Scales& s) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto is = [&](std::string_view id, std::size_t i) { return cause.id == id && index == i; };
  // A z that no pressure of the data saturates is linear in the pressure: a viscous branch.
  if (is("rate_dependent_hysteresis", 1)) return {0.01 * s.largest_kpa, 0.5 * s.largest_kpa};
  // One that does not relax within the data's cycles does not know their rate.
  if (is("rate_dependent_hysteresis", 2)) return {s.sample_s, 0.1 * s.campaign_s};
  // A loop that is wider by the same at all rates of the data is only wider.
  if (is("rate_dependent_hysteresis", 4)) return {0.05 * s.largest_kpa, 20 * s.largest_kpa};
  // What looks back farther is not a rate but a history.
  if (is("rate_dependent_hysteresis", 5)) return {0.5 * s.sample_s, 0.5};
  // Longer than all pressures, the way is a straight line.
  if (cause.id == "asymmetric_hysteresis" && (index == 1 || index == 2))
    return {0.01 * s.largest_kpa, 3 * s.largest_kpa};
  // From a damping of 1/sqrt(2) on nothing resonates: two lags in series.
  if (is("inertia", 1)) return {0.005, 0.7};
  // A shorter period than two samples is not seen.
  if (is("inertia", 0)) return {2 * s.sample_s, infinity};
  // A contact from the beginning on is a smaller gain; one that is hardly reached could be anything.
  if (is("contact", 0)) return {0.05 * s.span_mm, s.span_mm};
  // Below nearly all pressures nothing moves: then the data are of another actuator.
  if (is("actuator_threshold", 0)) return {0, 0.6 * s.largest_kpa};
  if (is("backlash", 0)) return {0, 0.5 * s.span_mm};
  // As fast as a branch of the base it is that branch; much slower than the campaign only gain per time
  // shows.
  if (is("slow_creep", 1)) {
    double slowest_s = 0;
    for (const double tau_s : branch_time_constants_s(model)) slowest_s = std::max(slowest_s, tau_s);
    return {std::min(1.5 * slowest_s, 0.15 * s.campaign_s), 20 * s.campaign_s};
  }
  // Run in sooner than this it is a load or two that differ; later only the trend shows.
  if (is("ageing", 2)) return {0.02 * s.campaign_s, 0.5 * s.campaign_s};
  // Warming up faster than this is creep of the actuator, slower a steady drift.
  if (is("sensor_drift", 2)) return {0.02 * s.campaign_s, s.campaign_s};
  // A wander turns a dozen times in a campaign at most; of a slower one than three campaigns only the trend
  // shows.
  if (is("sensor_drift", 5)) return {s.campaign_s / 12, 3 * s.campaign_s};
  if (is("periodic_disturbance", 2)) return {slowest_oscillation_hz(s.campaign_s), infinity};
  return {-infinity, infinity};
}

}  // namespace softgrip::sysid
