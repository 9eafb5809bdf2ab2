#pragma once
// The simulated fingers of the studies. Their parameters are constants of the program, so that a study does
// not depend on installed files. tests/tools/studies compares them with config/models.

#include "model/model.h"

namespace softgrip::studies {

inline constexpr double kpa_per_bar = 100;

/// Returns the published model with this value of eta [1/bar], which the paper does not state.
[[nodiscard]] model::Model published_model(double eta_per_bar);
/// Returns an ordinary actuator behind a valve, with beta = 0.57 (alpha + 1/k0). Omits the lag or the delay
/// if its value is 0.
[[nodiscard]] model::Model ordinary_model(double lag_s, double delay_s);
/// Returns the finger of the simulated rig, config/models/bench_twin.yaml.
[[nodiscard]] model::Model bench_twin();

/// Returns beta/(alpha + 1/k0). If this ratio is at least 1, the model has an inverse response.
[[nodiscard]] double wrong_way_ratio(const model::Model& model);
/// Returns the value of a parameter. Its path must exist in the model.
[[nodiscard]] double value_of(const model::Model& model, const char* path);

}  // namespace softgrip::studies
