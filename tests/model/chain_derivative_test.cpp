// The same chain under automatic differentiation: derivatives of the reading with respect to every parameter,
// against central differences, and the trial evaluation of the inverse against the step.

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/chain.h"
#include "model/dual.h"
#include "model/signals.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing {
namespace {

constexpr int most_parameters = 12;
using Jet = ceres::Jet<double, most_parameters>;
constexpr double dt = 5e-3;

std::vector<double> readings(const Model& model, SignalName signal, double sample_time_s) {
  Chain<double> chain(model, {}, sample_time_s);
  std::vector<double> y;
  for (int i = 1; i * dt <= duration_s(signal); ++i) y.push_back(chain.step(dt, value_kpa(signal, i * dt)));
  return y;
}

std::vector<Jet> readings_with_derivatives(const Model& model, SignalName signal, double sample_time_s) {
  const std::vector<double> values = flat_values(model);
  std::vector<Jet> jets;
  for (std::size_t i = 0; i < values.size(); ++i) jets.emplace_back(values[i], static_cast<int>(i));
  Chain<Jet> chain(model, jets, sample_time_s);
  std::vector<Jet> y;
  for (int i = 1; i * dt <= duration_s(signal); ++i) {
    y.push_back(chain.step(Jet(dt), Jet(value_kpa(signal, i * dt))));
  }
  return y;
}

void expect_derivatives_agree(const Model& model, SignalName signal) {
  const std::vector<double> values = flat_values(model);
  ASSERT_LE(values.size(), static_cast<std::size_t>(most_parameters));
  const std::vector<Jet> jets = readings_with_derivatives(model, signal, dt);
  const std::vector<double> plain = readings(model, signal, dt);
  for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_NEAR(jets[i].a, plain[i], 1e-11) << i;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (parameter_spec(model, k).whole) continue;
    const double h = 1e-5 * values[k];
    std::vector<double> up = values, down = values;
    up[k] += h;
    down[k] -= h;
    const std::vector<double> y_up = readings(with_values(model, up), signal, 0);
    const std::vector<double> y_down = readings(with_values(model, down), signal, 0);
    double largest = 0;
    double off = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      const double difference = (y_up[i] - y_down[i]) / (2 * h);
      largest = std::fmax(largest, std::fabs(difference));
      off = std::fmax(off, std::fabs(difference - jets[i].v[static_cast<int>(k)]));
    }
    EXPECT_GT(largest, 0) << parameter_path(model, k);
    EXPECT_LT(off, 2e-6 * largest) << parameter_path(model, k) << ", largest " << largest;
  }
}

TEST(ChainDerivatives, PublishedModelOnTriangles) {
  expect_derivatives_agree(preset("zhang2025"), SignalName::tp1);
}

// The delay is off the grid: on it the response to a kink has two one-sided derivatives.
TEST(ChainDerivatives, TwinWithFractionalDelayAndLag) {
  Model twin = preset("bench_twin");
  twin.blocks[0].values[0] = 0.1317;
  expect_derivatives_agree(twin, SignalName::tp1);
  expect_derivatives_agree(twin, SignalName::steps);
}

TEST(ChainDerivatives, DelayOnTheGridStillHasOne) {
  const Model twin = preset("bench_twin");
  Model later = twin;
  const double h = 1e-6;
  later.blocks[0].values[0] += h;
  const std::vector<Jet> jets = readings_with_derivatives(twin, SignalName::tp1, dt);
  const std::vector<double> a = readings(twin, SignalName::tp1, 0);
  const std::vector<double> b = readings(later, SignalName::tp1, 0);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR((b[i] - a[i]) / h, jets[i].v[0], 2e-2) << i;
}

TEST(ChainPeek, IsWhatTheStepWillGive) {
  for (const std::string name : {"zhang2025", "bench_twin"}) {
    Model model = preset(name);
    model = with_block(model, {*find_block("contact"), {9.0, 1.5}});
    model = only(model, [](const BlockInfo& info) { return info.inverse == Inverse::implicit; });
    Chain<double> chain(model, {}, dt);
    for (int i = 1; i * dt <= duration_s(SignalName::tp1); ++i) {
      const double p = value_kpa(SignalName::tp1, i * dt);
      const double trial = chain.peek(dt, p);
      const double h = 1e-4;
      const double up = chain.peek(dt, p + h);
      const double down = chain.peek(dt, p - h);
      const Dual<double> dual = chain.peek(dt, Dual<double>(p, 1.0));
      const double y = chain.step(dt, p);
      ASSERT_NEAR(trial, y, 1e-12) << name << " " << i;
      ASSERT_NEAR(dual.a, y, 1e-12);
      // Where the pressure turns or the contact begins the derivative has a kink: one side or the other.
      const double low = std::fmin((up - trial) / h, (trial - down) / h);
      const double high = std::fmax((up - trial) / h, (trial - down) / h);
      ASSERT_GE(dual.v, low - 1e-6) << name << " " << i;
      ASSERT_LE(dual.v, high + 1e-6) << name << " " << i;
    }
  }
}

}  // namespace
}  // namespace softgrip::model::testing
