// Parameter values of the hidden effects.
#include <cmath>
#include <random>
#include <stdexcept>

#include "world.h"

namespace textbook {

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
                                            "outliers",
                                            "leak"};
  return ids;
}

Numbers draw_effect(const std::string& id, double s, const Setting& setting, std::uint64_t seed) {
  std::mt19937_64 random(seed * 15485863 + 29);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double sign = between(-1, 1) < 0 ? -1 : 1;
  const double span = setting.world.finger.span_mm, largest = setting.largest_mm;
  if (id == "transport_delay") return {{"delay_s", 0.8 * s}};
  if (id == "valve_lag") return {{"time_constant_s", 1.2 * s}};
  if (id == "valve_deadband") return {{"band_kpa", 20 * s}};
  if (id == "pressure_saturation") return {{"limit_kpa", working_kpa * (1 - 0.7 * s)}};
  if (id == "supply_sag") return {{"per_supply", 4 * s}};
  if (id == "actuator_threshold") return {{"threshold_kpa", 30 * s}};
  if (id == "stiffening") return {{"per_mm", 5 * s / span}};
  if (id == "asymmetric_hysteresis") return {{"share", 1.5 * s}};
  if (id == "rate_dependent_hysteresis") return {{"kpa", 20 * s}};
  if (id == "stress_softening") return {{"share", 1.2 * s}, {"range_kpa", between(8, 15)}};
  if (id == "slow_creep")
    return {{"gain_mm_per_kpa", 1.5 * s * span / working_kpa}, {"time_constant_s", between(60, 180)}};
  if (id == "thermal_gain") return {{"per_c", 0.2 * s * sign}};
  if (id == "ageing") return {{"per_s", 0.9 * s * sign / setting.campaign_s}};
  if (id == "contact")
    return {{"position_mm", largest * (1 - 0.85 * s)}, {"stiffness_ratio", between(3, 10)}};
  if (id == "inertia") return {{"frequency_hz", 0.35 / std::pow(s, 0.75)}, {"damping", between(0.15, 0.35)}};
  if (id == "backlash") return {{"play_mm", 0.6 * span * s}};
  if (id == "sensor_lag") return {{"time_constant_s", 1.5 * s}};
  if (id == "sensor_drift") return {{"mm", 0.4 * span * s * sign}, {"phase", between(0, 6)}};
  if (id == "sensor_nonlinearity") return {{"share", 0.95 * s * sign}};
  if (id == "sensor_saturation") return {{"limit_mm", largest * (1 - 0.85 * s)}};
  if (id == "periodic_disturbance") return {{"mm", 0.3 * span * s}, {"frequency_hz", between(1.5, 8)}};
  if (id == "outliers") return {{"share", between(0.002, 0.01)}, {"size_mm", span * s}};
  if (id == "leak") return {{"conductance", 2 * setting.world.valve.tube_conductance * s}};
  if (id == "blocked_line")
    return {{"share", 0.95 * s}};  // library_ids() omits this cause, because it explains a change of a
                                   // finger, but no model error
  throw std::invalid_argument("unknown cause " + id);
}

}  // namespace textbook
