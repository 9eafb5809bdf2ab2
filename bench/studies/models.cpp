#include "bench/studies/models.h"

#include <array>
#include <utility>
#include <vector>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"

namespace softgrip::studies {
namespace {

template <template <class> class Block>
model::BlockSpec block(std::vector<double> values) {
  return {model::block_type<Block>(), std::move(values)};
}

/// Returns the stiffness k and the viscosity c of a Kelvin-Voigt branch with a given gain and time constant.
std::array<double, 2> branch(double gain_mm_per_bar, double time_constant_s) {
  const double k = kpa_per_bar / gain_mm_per_bar;
  return {k, k * time_constant_s};
}

}  // namespace

model::Model published_model(double eta_per_bar) {
  model::Model model;
  model.name = "zhang2025";
  model = model::with_block(model,
                            block<model::BoucWen>({0.07079, 0.17207, 0.02093, eta_per_bar / kpa_per_bar, 1}));
  return model::with_block(model, block<model::KelvinVoigt>({325.9, 18.0, 246.1, 2.0, 1.2}));
}

model::Model ordinary_model(double lag_s, double delay_s) {
  model::Model model;
  model.name = "ordinary";
  if (delay_s > 0) model = model::with_block(model, block<model::TransportDelay>({delay_s}));
  if (lag_s > 0) model = model::with_block(model, block<model::ValveLag>({lag_s}));
  model = model::with_block(model, block<model::BoucWen>({0.35, 0.20, 0.03, 0.05, 1}));
  const auto slow = branch(5.6, 13.7);
  const auto fast = branch(25, 0.4);
  return model::with_block(
      model, block<model::KelvinVoigt>({kpa_per_bar / 0.3, slow[0], slow[1], fast[0], fast[1]}));
}

model::Model bench_twin() {
  model::Model model;
  model.name = "bench_twin";
  model = model::with_block(model, block<model::TransportDelay>({0.13}));
  model = model::with_block(model, block<model::ValveLag>({0.044}));
  model = model::with_block(model, block<model::BoucWen>({0.21105, 0.1713, 0.01625, 0.02428, 1}));
  return model::with_block(model, block<model::KelvinVoigt>({325.9, 18.16, 299.8, 2.761, 1.621}));
}

double value_of(const model::Model& model, const char* path) {
  return model::flat_values(model)[model::find_path(model, path).value()];
}

double wrong_way_ratio(const model::Model& model) {
  return value_of(model, "bouc_wen.beta_mm_per_kpa") /
         (value_of(model, "bouc_wen.alpha_mm_per_kpa") + 1 / value_of(model, "kelvin_voigt.k0_kpa_per_mm"));
}

}  // namespace softgrip::studies
