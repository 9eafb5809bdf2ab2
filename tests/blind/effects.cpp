// The effects that can be hidden in a world, with the largest physical size of each effect.
#include <algorithm>
#include <random>
#include <stdexcept>

#include "world.h"

namespace blind {

const std::vector<std::string>& library_ids() {
  static const std::vector<std::string> ids{"transport_delay",
                                            "valve_lag",
                                            "valve_deadband",
                                            "pressure_saturation",
                                            "supply_sag",
                                            "actuator_threshold",
                                            "stiffening",
                                            "asymmetric_hysteresis",
                                            "rate_dependent_hysteresis",
                                            "stress_softening",
                                            "slow_creep",
                                            "thermal_gain",
                                            "ageing",
                                            "contact",
                                            "inertia",
                                            "backlash",
                                            "sensor_lag",
                                            "sensor_drift",
                                            "sensor_nonlinearity",
                                            "sensor_saturation",
                                            "periodic_disturbance",
                                            "outliers"};
  return ids;
}

const std::vector<std::string>& outside_ids() {
  static const std::vector<std::string> ids{"outside_fill_vent_lag",   "outside_bumps",
                                            "outside_gain_modulation", "outside_stop_operators",
                                            "outside_crosstalk",       "outside_rest_recovery"};
  return ids;
}

Effect draw_effect(const std::string& id, double s, std::uint64_t seed, double span_mm, double campaign_s) {
  std::mt19937_64 random(seed * 0x9E3779B97F4A7C15ULL + 17);
  std::uniform_real_distribution<double> unit(0, 1);
  const double a = unit(random), b = unit(random);
  const double sign = a < 0.5 ? -1 : 1;
  if (id == "transport_delay") return {{"delay_s", 0.5 * s}};
  if (id == "valve_lag") return {{"time_constant_s", 0.5 * s}};
  if (id == "valve_deadband") return {{"band_kpa", 12 * s}};
  if (id == "pressure_saturation") return {{"limit_kpa", 60 - 30 * s}};
  if (id == "supply_sag") return {{"sensitivity", 1.0 * s}};
  if (id == "actuator_threshold") return {{"threshold_kpa", 15 * s}};
  if (id == "stiffening") return {{"per_mm", 1.5 * s / span_mm}};
  if (id == "asymmetric_hysteresis") return {{"delta_per_kpa", 0.075 * s}};
  if (id == "rate_dependent_hysteresis") return {{"growth", 3 * s}};
  if (id == "stress_softening") return {{"per_kpa", 0.02 * s}};
  if (id == "slow_creep") return {{"gain_mm_per_kpa", 0.8 * s}, {"time_constant_s", 90 + 200 * a}};
  if (id == "thermal_gain") return {{"per_c", 0.05 * s * sign}};
  if (id == "ageing") return {{"per_s", 0.5 * s * sign / campaign_s}};
  if (id == "contact") return {{"position_mm", (0.55 + 0.25 * a) * span_mm}, {"stiffness_ratio", 3 * s}};
  if (id == "inertia") return {{"frequency_hz", std::min(0.8 / s, 60.0)}, {"damping", 0.1 + 0.2 * a}};
  if (id == "backlash") return {{"play_mm", 0.25 * span_mm * s}};
  if (id == "sensor_lag") return {{"time_constant_s", 0.5 * s}};
  if (id == "sensor_drift")
    return {{"amplitude_mm", 0.3 * span_mm * s}, {"period_s", (0.7 + a) * campaign_s}, {"phase", 6.28 * b}};
  if (id == "sensor_nonlinearity") return {{"bend_mm", 0.25 * span_mm * s * sign}, {"span_mm", span_mm}};
  if (id == "sensor_saturation") return {{"limit_mm", span_mm * (1 - 0.5 * s)}};
  if (id == "periodic_disturbance")
    return {{"amplitude_mm", 0.2 * span_mm * s}, {"frequency_hz", 0.7 + 8 * a}, {"phase", 6.28 * b}};
  if (id == "outliers") return {{"size_mm", span_mm * s}, {"share", 0.004 + 0.01 * a}};
  if (id == "outside_fill_vent_lag") return {{"fill_s", 0.3 * s}, {"vent_s", 1.2 * s}};
  if (id == "outside_bumps") return {{"size_mm", 0.5 * span_mm * s}};
  if (id == "outside_gain_modulation") return {{"depth", 0.4 * s}, {"frequency_hz", 0.15 + 0.4 * a}};
  if (id == "outside_stop_operators") return {{"gain_mm_per_kpa", 0.3 * s}};
  if (id == "outside_crosstalk") return {{"amplitude_mm", 0.3 * span_mm * s}};
  if (id == "outside_rest_recovery") return {{"depth", 0.4 * s}};
  throw std::invalid_argument("no effect '" + id + "'");
}

}  // namespace blind
