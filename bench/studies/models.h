#pragma once
// Defines the models of the simulated fingers of the studies. The parameter values are constants of the
// program, so that a study does not depend on installed files. A test in tests/bench/studies compares these
// values with config/models.

#include "model/model.h"

namespace softgrip::studies {

inline constexpr double kpa_per_bar = 100;

/// Returns the model of Zhang et al. 2025 with the given value of eta [1/bar], because the paper does not
/// state eta.
[[nodiscard]] model::Model published_model(double eta_per_bar);
/// Returns the model of an ordinary actuator behind a valve, with beta = 0.57 (alpha + 1/k0). A lag or a
/// delay of 0 s is left out of the model.
[[nodiscard]] model::Model ordinary_model(double lag_s, double delay_s);
/// Returns the model of the simulated rig's finger, which equals config/models/bench_twin.yaml.
[[nodiscard]] model::Model bench_twin();

/// Returns the ratio beta/(alpha + 1/k0) of a model. If this ratio is at least 1, the model has an inverse
/// response.
[[nodiscard]] double wrong_way_ratio(const model::Model& model);
/// Returns the value of the parameter with the path `path`. The model must have this parameter.
[[nodiscard]] double value_of(const model::Model& model, const char* path);

}  // namespace softgrip::studies
