// Compares the chain with a solution by CVODE for the same piecewise linear command. The difference must be
// below 1e-6 mm at each tested sampling rate. With a resonance after a step of the command, it must be below
// 1.5e-4 mm.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "model/chain.h"
#include "model/signals.h"
#include "tests/model/presets.h"
#include "tests/model/reference.h"

namespace softgrip::model::testing::chain_reference_test {
namespace {

Physics physics_of(const Model& model) {
  Physics f;
  f.delay_s = number(model, "transport_delay.delay_s");
  f.lag_s = number(model, "valve_lag.time_constant_s");
  f.alpha = number(model, "bouc_wen.alpha_mm_per_kpa");
  f.beta = number(model, "bouc_wen.beta_mm_per_kpa");
  f.gamma = number(model, "bouc_wen.gamma_per_kpa");
  f.eta = number(model, "bouc_wen.eta_per_kpa");
  f.exponent = static_cast<int>(number(model, "bouc_wen.exponent"));
  f.k0 = number(model, "kelvin_voigt.k0_kpa_per_mm");
  for (int i = 1; find_path(model, "kelvin_voigt.k" + std::to_string(i) + "_kpa_per_mm"); ++i) {
    f.k.push_back(number(model, "kelvin_voigt.k" + std::to_string(i) + "_kpa_per_mm"));
    f.c.push_back(number(model, "kelvin_voigt.c" + std::to_string(i) + "_kpa_s_per_mm"));
  }
  return f;
}

struct Case {
  std::string model;
  SignalName signal;
  double rate_hz;
};

class ChainReference : public ::testing::TestWithParam<Case> {};

double largest_error(const Model& model, SignalName signal, double rate_hz) {
  const double dt = 1.0 / rate_hz;
  const auto count = static_cast<std::size_t>(std::lround(duration_s(signal) * rate_hz)) + 1;
  std::vector<double> command(count);
  for (std::size_t i = 0; i < count; ++i) command[i] = value_kpa(signal, static_cast<double>(i) * dt);
  const std::vector<double> expected = integrate(physics_of(model), command, dt);
  Chain<double> chain(model, {}, dt);
  double worst = 0;
  for (std::size_t i = 1; i < count; ++i) {
    worst = std::fmax(worst, std::fabs(chain.step(dt, command[i]) - expected[i]));
  }
  return worst;
}

TEST_P(ChainReference, AgreesWithCvodeWithinOneNanometre) {
  const Case& c = GetParam();
  const double worst = largest_error(preset(c.model), c.signal, c.rate_hz);
  RecordProperty("largest_error_mm", std::to_string(worst * 1e9) + " e-9");
  EXPECT_LT(worst, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Presets, ChainReference,
    ::testing::Values(Case{"zhang2025", SignalName::tp1, 1000}, Case{"zhang2025", SignalName::tp1, 200},
                      Case{"zhang2025", SignalName::steps, 1000}, Case{"zhang2025", SignalName::steps, 200},
                      Case{"bench_twin", SignalName::tp1, 1000}, Case{"bench_twin", SignalName::tp1, 200},
                      Case{"bench_twin", SignalName::steps, 1000},
                      Case{"bench_twin", SignalName::steps, 200}),
    [](const auto& param) {
      return param.param.model + "_" + std::string(name_of(param.param.signal)) + "_" +
             std::to_string(static_cast<int>(param.param.rate_hz)) + "Hz";
    });

// Tests the exponents 2, 3 and 4 with the model bench_twin. gamma and eta are scaled so that the state
// saturates at the same value for each exponent.
TEST(ChainReferenceExponents, AgreeWithCvodeForHigherExponents) {
  for (const int exponent : {2, 3, 4}) {
    Model model = preset("bench_twin");
    std::vector<double>& v = model.blocks[*position_of(model, "bouc_wen")].values;
    const double level = v[1] / (v[2] + v[3]);
    v[2] *= std::pow(level, 1 - exponent);
    v[3] *= std::pow(level, 1 - exponent);
    v[4] = exponent;
    EXPECT_LT(largest_error(model, SignalName::tp1, 1000), 1e-6) << exponent;
    EXPECT_LT(largest_error(model, SignalName::tp2, 200), 1e-6) << exponent;
  }
}

TEST(ChainReferenceFractionalDelay, AgreesWithCvodeForAFractionalDelay) {
  for (const double delay : {0.0004, 0.1237}) {
    Model model = preset("bench_twin");
    model.blocks[0].values[0] = delay;
    EXPECT_LT(largest_error(model, SignalName::tp1, 1000), 1e-6) << delay;
    EXPECT_LT(largest_error(model, SignalName::steps, 200), 1e-6) << delay;
    EXPECT_LT(largest_error(model, SignalName::sp1, 200), 1e-6) << delay;
  }
}

// The command rises by 44 kPa within one sample of 10 ms, and later falls by 44 kPa within one sample. The
// expected displacement is computed with steps of 0.1 ms.
constexpr double sample_s = 0.01;
constexpr std::size_t finer = 100, samples = 60;

double leapt_kpa(double time_s) {
  return 44 *
         (std::clamp((time_s - 0.1) / sample_s, 0.0, 1.0) - std::clamp((time_s - 0.35) / sample_s, 0.0, 1.0));
}

std::vector<double> displacement_mm(const Model& model) {
  std::vector<double> command_kpa;
  for (std::size_t i = 0; i <= samples * finer; ++i)
    command_kpa.push_back(leapt_kpa(static_cast<double>(i) * sample_s / finer));
  return integrate(physics_of(model), command_kpa, sample_s / finer);
}

/// Solves z'' = acceleration(z, z', y) with the classical Runge-Kutta method. Returns z at the sample times.
template <class Acceleration>
std::vector<double> followed_mm(const std::vector<double>& y, Acceleration&& acceleration) {
  const double h = sample_s / finer;
  std::vector<double> at_samples{0};
  double z = 0, v = 0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    const double middle = (y[i - 1] + y[i]) / 2;
    const double z1 = v, v1 = acceleration(z, v, y[i - 1]);
    const double z2 = v + h / 2 * v1, v2 = acceleration(z + h / 2 * z1, z2, middle);
    const double z3 = v + h / 2 * v2, v3 = acceleration(z + h / 2 * z2, z3, middle);
    const double z4 = v + h * v3, v4 = acceleration(z + h * z3, z4, y[i]);
    z += h / 6 * (z1 + 2 * z2 + 2 * z3 + z4);
    v += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    if (i % finer == 0) at_samples.push_back(z);
  }
  return at_samples;
}

TEST(ChainReferenceLeap, InertiaAgreesAfterAStepOfTheHysteresis) {
  constexpr double period_s = 0.045, damping = 0.16, omega = 2 * std::numbers::pi / period_s;
  const Model finger = preset("zhang2025");
  const std::vector<double> expected = followed_mm(displacement_mm(finger), [](double z, double v, double y) {
    return omega * omega * (y - z) - 2 * damping * omega * v;
  });
  BlockSpec inertia = default_block(*find_block("inertia"));
  inertia.values = {period_s, damping};
  Chain<double> chain(with_block(finger, inertia), {}, sample_s);
  double worst_mm = 0;
  for (std::size_t i = 1; i <= samples; ++i) {
    const double z = chain.step(sample_s, leapt_kpa(static_cast<double>(i) * sample_s));
    worst_mm = std::fmax(worst_mm, std::fabs(z - expected[i]));
  }
  EXPECT_LT(worst_mm, 1.5e-4);
}

}  // namespace
}  // namespace softgrip::model::testing::chain_reference_test
