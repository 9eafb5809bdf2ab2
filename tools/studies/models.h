#pragma once
// The fingers of the studies, with their numbers in them: a study must not depend on which files are
// installed. tests/tools/studies compares them with config/models.

#include "model/model.h"

namespace softgrip::tools {

inline constexpr double kpa_per_bar = 100;

/// The published model with the given eta [1/bar], which was never published.
[[nodiscard]] model::Model published_model(double eta_per_bar);
/// An ordinary actuator, beta = 0.57 (alpha + 1/k0), behind a valve (0: no such block).
[[nodiscard]] model::Model ordinary_model(double lag_s, double delay_s);
/// The finger of the simulated rig: config/models/bench_twin.yaml.
[[nodiscard]] model::Model bench_twin();

/// beta/(alpha + 1/k0): from 1 on the model moves the wrong way first.
[[nodiscard]] double wrong_way_ratio(const model::Model& model);
/// A value by its path, which must exist.
[[nodiscard]] double value_of(const model::Model& model, const char* path);

}  // namespace softgrip::tools
