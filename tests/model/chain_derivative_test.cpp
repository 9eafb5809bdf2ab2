// Tests the automatic differentiation of the chain. Compares the derivative of the reading with respect to
// each parameter with finite differences. Also compares step() with peek(), which the inverse uses.

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/chain.h"
#include "model/chain_walk.h"
#include "model/dual.h"
#include "model/signals.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing::chain_derivative_test {
namespace {

constexpr int most_parameters = 20;
using Jet = ceres::Jet<double, most_parameters>;
constexpr double dt = 5e-3;

// Returns surroundings (time, supply pressure and temperature) in which every block has an effect.
Surroundings around(double time_s) {
  Surroundings s;
  s.time_s = time_s;
  s.supply_kpa = 450 + 40 * std::sin(0.3 * time_s);
  s.temperature_c = 24 + 3 * std::cos(0.2 * time_s);
  return s;
}

std::vector<double> readings(const Model& model, SignalName signal, double sample_time_s) {
  Chain<double> chain(model, {}, sample_time_s);
  std::vector<double> y;
  for (int i = 1; i * dt <= duration_s(signal); ++i)
    y.push_back(chain.step(dt, value_kpa(signal, i * dt), around(i * dt)));
  return y;
}

std::vector<Jet> readings_with_derivatives(const Model& model, SignalName signal, double sample_time_s) {
  const std::vector<double> values = flat_values(model);
  std::vector<Jet> jets;
  for (std::size_t i = 0; i < values.size(); ++i) jets.emplace_back(values[i], static_cast<int>(i));
  Chain<Jet> chain(model, jets, sample_time_s);
  std::vector<Jet> y;
  for (int i = 1; i * dt <= duration_s(signal); ++i) {
    y.push_back(chain.step(Jet(dt), Jet(value_kpa(signal, i * dt)), around(i * dt)));
  }
  return y;
}

// Returns true if the chain gives no derivative with respect to the parameter, because the parameter is an
// exponent, controls random numbers or is the step of a quantisation. A fit must not change such a parameter.
bool has_no_derivative(const std::string& path) {
  return path == "bouc_wen.exponent" || path == "sensor_noise.correlation_time_s" ||
         path == "outliers.probability" || path == "quantisation.step_mm";
}

/// @param is_compared  selects the parameters, by their index, whose derivatives are compared.
template <class IsCompared>
void expect_derivatives_agree(const Model& model, SignalName signal, IsCompared is_compared) {
  const std::vector<double> values = flat_values(model);
  ASSERT_LE(values.size(), static_cast<std::size_t>(most_parameters));
  const std::vector<Jet> jets = readings_with_derivatives(model, signal, dt);
  const std::vector<double> plain = readings(model, signal, dt);
  for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_NEAR(jets[i].a, plain[i], 1e-11) << i;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (has_no_derivative(parameter_path(model, k)) || !is_compared(k)) continue;
    const double h = 1e-6 * (values[k] == 0 ? 1.0 : std::fabs(values[k]));
    std::vector<double> up = values, down = values;
    up[k] += h;
    down[k] -= h;
    const std::vector<double> y_up = readings(with_values(model, up), signal, 0);
    const std::vector<double> y_down = readings(with_values(model, down), signal, 0);
    // At a kink, the two one-sided finite differences are unequal. Examples of a kink are a corner of the
    // signal and the start of a contact. The derivative must lie between the two differences.
    double largest = 0;
    double outside = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      const double derivative = jets[i].v[static_cast<int>(k)];
      const double ahead = (y_up[i] - plain[i]) / h;
      const double behind = (plain[i] - y_down[i]) / h;
      largest = std::fmax(largest, std::fabs(derivative));
      outside = std::fmax(
          outside, std::fmax(std::fmin(ahead, behind) - derivative, derivative - std::fmax(ahead, behind)));
    }
    EXPECT_LT(outside, 2e-6 * std::fmax(largest, 1e-3))
        << parameter_path(model, k) << ", largest " << largest;
  }
}

void expect_derivatives_agree(const Model& model, SignalName signal) {
  expect_derivatives_agree(model, signal, [](std::size_t) { return true; });
}

TEST(ChainDerivatives, AgreeWithDifferencesForThePublishedModel) {
  expect_derivatives_agree(preset("zhang2025"), SignalName::tp1);
}

// The delay is not a multiple of the sample time. If the delay were a multiple, the response to a kink would
// have two different one-sided derivatives.
TEST(ChainDerivatives, AgreeWithDifferencesForAFractionalDelay) {
  Model twin = preset("bench_twin");
  twin.blocks[0].values[0] = 0.1317;
  expect_derivatives_agree(twin, SignalName::tp1);
  expect_derivatives_agree(twin, SignalName::steps);
}

TEST(ChainDerivatives, DelayOfWholeSamplesHasADerivative) {
  const Model twin = preset("bench_twin");
  Model later = twin;
  const double h = 1e-6;
  later.blocks[0].values[0] += h;
  const std::vector<Jet> jets = readings_with_derivatives(twin, SignalName::tp1, dt);
  const std::vector<double> a = readings(twin, SignalName::tp1, 0);
  const std::vector<double> b = readings(later, SignalName::tp1, 0);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR((b[i] - a[i]) / h, jets[i].v[0], 2e-2) << i;
}

// Compares all parameters of each block, and a third of the parameters of the other blocks, a different third
// for consecutive blocks. The derivatives of all other blocks pass through a block in the same way.
TEST(ChainDerivatives, EveryBlockAgreesWithFiniteDifferences) {
  Model twin = preset("bench_twin");
  twin.blocks[0].values[0] = 0.1317;
  const auto expect_block_agrees = [&](const BlockSpec& block) {
    const Model model = with_block(twin, block);
    const std::size_t own = *position_of(model, block.type);
    expect_derivatives_agree(model, SignalName::tp2, [&](std::size_t k) {
      return place_of(model, k).block == own || k % 3 == block.type % 3;
    });
  };
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    const std::string_view id = catalogue()[type].info.id;
    if (position_of(twin, type) || id == "pressure_saturation" || id == "quantisation") continue;
    if (type == block_type<ValveStiction>() || type == block_type<RateDependentSaturation>()) continue;
    SCOPED_TRACE(id);
    expect_block_agrees(default_block(type));
  }
  expect_block_agrees({*find_block("pressure_saturation"), {41.3}});
  // With this stick band, the valve does not break free exactly at a sample time. If the valve did, the
  // response to a jump would have two different one-sided derivatives.
  expect_block_agrees({block_type<ValveStiction>(), {2.37}});
  // These parameter values are large. With smaller values, the rounding errors of the finite differences
  // would exceed the derivative.
  expect_block_agrees({block_type<RateDependentSaturation>(), {3.0, 20.0, 0.05}});
}

// At the value 0, each of these parameters has no effect. The derivative at 0 must not be 0, so that a fit
// finds the direction in which the parameter must change.
TEST(ChainDerivatives, AreNonzeroAtNeutralValues) {
  const Model twin = preset("bench_twin");
  for (const std::string id : {"supply_sag",
                               "leak",
                               "pressure_scale",
                               "stress_softening",
                               "pseudo_elastic_softening",
                               "slow_creep",
                               "duhem_hysteresis",
                               "crescent_hysteresis",
                               "asymmetric_bouc_wen",
                               "relaxing_friction",
                               "rate_dependent_width",
                               "rate_dependent_saturation",
                               "stiffening",
                               "thermal_gain",
                               "ageing",
                               "running_in",
                               "wear",
                               "contact",
                               "actuator_threshold",
                               "valve_deadband",
                               "backlash",
                               "sensor_nonlinearity",
                               "sensor_drift",
                               "sensor_warm_up",
                               "sensor_sinusoidal_drift",
                               "sensor_piecewise_drift",
                               "periodic_disturbance"}) {
    const Model model = with_block(twin, neutral_block(*find_block(id)));
    const BlockSpec& block = model.blocks[*position_of(model, id)];
    const std::size_t index = *find_path(
        model, id + "." + parameter_name(block, id == "contact" || id == "sensor_piecewise_drift" ? 1 : 0));
    double largest = 0;
    for (const Jet& y : readings_with_derivatives(model, SignalName::tp1, dt)) {
      largest = std::fmax(largest, std::fabs(y.v[static_cast<int>(index)]));
    }
    EXPECT_GT(largest, 1e-3) << id;
    EXPECT_TRUE(std::isfinite(largest)) << id;
  }
}

constexpr double derivative_tolerance = 1e-5;

// Returns the distance of the derivative of peek() from the interval between its two one-sided finite
// differences. At a kink, for example a reversal of the pressure, these differences are unequal, and the
// derivative equals one of them. Close to a kink, neither difference is the slope at p, so the function tries
// smaller step sizes.
double outside_of_differences(Chain<double>& chain, double p, const Surroundings& now,
                              const Dual<double>& trial) {
  double outside = 0;
  for (const double h : {1e-4, 1e-5, 1e-6}) {
    const double ahead = (chain.peek(dt, p + h, now) - trial.a) / h;
    const double behind = (trial.a - chain.peek(dt, p - h, now)) / h;
    outside = std::fmax(std::fmin(ahead, behind) - trial.v, trial.v - std::fmax(ahead, behind));
    const bool kink = std::fabs(ahead - behind) > derivative_tolerance;
    if (!(outside > derivative_tolerance) || !kink) break;
  }
  return outside;
}

TEST(ChainPeek, PeekPredictsTheResultOfStep) {
  // The test uses only the blocks with an implicit inverse. `all` contains each of these blocks. `smooth`
  // omits those that change the pressure in the actuator and are not in bench_twin.
  std::vector<Model> models{preset("zhang2025"), preset("bench_twin"),
                            with_block(preset("zhang2025"), {*find_block("contact"), {9.0, 1.5}})};
  Model smooth = preset("bench_twin");
  Model all = smooth;
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    if (position_of(all, type)) continue;
    BlockSpec block = default_block(type);
    // If the pressure has a corner within a sample, the rate of the pressure changes within the sample. Only
    // step() takes this corner into account, so RateDependentWidth gets parameter values with which it has no
    // effect.
    if (type == block_type<RateDependentWidth>()) block = neutral_block(type);
    all = with_block(all, block);
    const BlockInfo& info = catalogue()[type].info;
    if (info.station == Station::valve || info.kind != Kind::pressure) {
      smooth = with_block(smooth, default_block(type));
    }
  }
  models.push_back(smooth);
  models.push_back(all);
  // Only step() takes a corner within a sample into account, for example at a threshold that the pressure
  // crosses. The tolerance is therefore larger for the model with all blocks.
  const std::size_t with_corners = models.size() - 1;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const double tolerance = m == with_corners ? 1e-4 : 1e-12;
    Model model = only(models[m], [](const BlockInfo& info) { return info.inverse == Inverse::implicit; });
    Chain<double> chain(model, {}, dt);
    for (int i = 1; i * dt <= duration_s(SignalName::tp1); ++i) {
      const double p = value_kpa(SignalName::tp1, i * dt);
      const Surroundings now = around(i * dt);
      const double trial = chain.peek(dt, p, now);
      const Dual<double> dual = chain.peek(dt, Dual<double>(p, 1.0), now);
      const double outside = outside_of_differences(chain, p, now, dual);
      const double y = chain.step(dt, p, now);
      ASSERT_NEAR(trial, y, tolerance) << model.blocks.size() << " blocks, sample " << i;
      ASSERT_NEAR(dual.a, y, tolerance);
      ASSERT_LE(outside, derivative_tolerance) << model.blocks.size() << " blocks, sample " << i;
    }
  }
}

}  // namespace
}  // namespace softgrip::model::testing::chain_derivative_test
