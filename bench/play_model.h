#pragma once
// Defines a model of a finger with play operators. The model has as many parameters as an identified model
// usually has. The benchmarks compare its computing time with that of a Bouc-Wen model.

#include <cmath>
#include <utility>
#include <vector>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/transport_delay.h"
#include "model/named.h"

namespace softgrip::bench {

/// Returns a model with 12 play operators with thresholds up to 57 kPa, 7 creep branches and a nonlinear
/// characteristic. Its dead time is that of the model bench_twin, and its valve fills faster than it vents.
/// The parameter values are examples and not measurements. The finger reaches 20 mm at a pressure below 60
/// kPa.
inline model::Model play_model() {
  constexpr int plays = 12, branches = 7;
  std::vector<double> hysteresis{0, 0, 0, 0, 0, 0.15}, creep{1e9};
  for (int i = 1; i < plays; ++i) {
    const double threshold_kpa = 57 * std::pow(static_cast<double>(i) / plays, 1.5);
    hysteresis.insert(hysteresis.end(), {threshold_kpa, 0.03});
  }
  for (int i = 0; i < branches; ++i) {
    const double stiffness_kpa_per_mm = 40, time_constant_s = 0.05 * std::pow(3.0, i);
    creep.insert(creep.end(), {stiffness_kpa_per_mm, stiffness_kpa_per_mm * time_constant_s});
  }
  model::Model finger;
  for (model::BlockSpec block : {model::BlockSpec{model::block_type<model::TransportDelay>(), {0.13}},
                                 {model::block_type<model::AsymmetricValveLag>(), {0.044, 0.09}},
                                 {model::block_type<model::PrandtlIshlinskii>(), hysteresis},
                                 {model::block_type<model::KelvinVoigt>(), creep},
                                 {model::block_type<model::Characteristic>(), {1.5, 30}}}) {
    finger = model::with_block(std::move(finger), std::move(block));
  }
  return finger;
}

}  // namespace softgrip::bench
