#include "control/feedforward/actuator_inverse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "control/feedforward/running_model.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/contact.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_dependent_creep.h"
#include "model/named.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::actuator_inverse_test {
namespace {

using sim::model_named;
using sim::tick_s;

// Returns a displacement over time that contains slow parts, fast parts and minor hysteresis loops. The
// finger can reach this displacement with at most 60 kPa.
double wanted_mm(double t) {
  const double rise = 1 - std::exp(-t * t);
  return rise * (12 - 4 * std::cos(0.7 * t) - 2 * std::cos(2.3 * t + 0.4) + 0.6 * std::sin(9 * t));
}

/// Returns an actuator with twelve generalised play operators, seven creep branches, pressure-dependent creep
/// and a nonlinear gain.
model::Model play_body() {
  model::Model m;
  std::vector<double> plays{0, 0.2, -0.1, 50, 0, 0.15}, ladder{1e9};
  for (int i = 1; i < 12; ++i) plays.insert(plays.end(), {57 * std::pow(i / 12.0, 1.5), 0.03});
  for (int i = 0; i < 7; ++i) ladder.insert(ladder.end(), {40, 40 * 0.05 * std::pow(3.0, i)});
  m = model::with_block(std::move(m), {model::block_type<model::PrandtlIshlinskii>(), plays});
  m = model::with_block(std::move(m), {model::block_type<model::KelvinVoigt>(), ladder});
  m = model::with_block(std::move(m), {model::block_type<model::PressureDependentCreep>(), {20, 0.02, 3}});
  return model::with_block(std::move(m), {model::block_type<model::Characteristic>(), {1.5, 30}});
}

TEST(ActuatorInverse, RecoversThePressureOfPlayOperatorsOver100000Steps) {
  const model::Model body = play_body();
  ASSERT_TRUE(model::validate(body).empty()) << model::validate(body).front();
  ActuatorInverse inverse(body, tick_s);
  model::Chain<double> finger(body, {}, tick_s);
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> pressure(0, 60);
  std::uniform_int_distribution<int> ticks(1, 60);
  double at = 0, worst_mm = 0, worst_kpa = 0;
  for (int k = 0; k < 100'000;) {
    const double to = pressure(random), from = at;
    const int count = ticks(random);
    for (int i = 1; i <= count; ++i, ++k) {
      at = from + (to - from) * i / count;
      finger.step(tick_s, at);
      const auto solution = inverse.solve(finger.reading_mm(), 0, 60);
      inverse.advance(solution.pressure_kpa);
      worst_kpa = std::max(worst_kpa, std::abs(solution.pressure_kpa - at));
      worst_mm = std::max(worst_mm, std::abs(inverse.displacement_mm() - finger.reading_mm()));
    }
  }
  EXPECT_LT(worst_mm, 1e-9) << "seed 31";
  EXPECT_LT(worst_kpa, 1e-7) << "seed 31";
}

TEST(ActuatorInverse, TheModelWithTheInverseReproducesTheReference) {
  const model::Model body = body_of(model_named("bench_twin"));
  ActuatorInverse inverse(body, tick_s);
  model::Chain<double> finger(body, {}, tick_s);
  double worst = 0;
  double highest = 0;
  for (int k = 1; k <= 8000; ++k) {
    const double wanted = std::max(0.0, wanted_mm(k * tick_s));
    const auto solution = inverse.solve(wanted, 0, 60);
    ASSERT_TRUE(solution.reached) << "at " << k * tick_s;
    inverse.advance(solution.pressure_kpa);
    finger.step(tick_s, solution.pressure_kpa);
    worst = std::max(worst, std::abs(finger.reading_mm() - wanted));
    highest = std::max(highest, solution.pressure_kpa);
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(highest, 15) << "the reference requires at most 15 kPa, so this test is too easy";
}

// Tests the pressure that the inverse computes for a displacement, with the exponents 1 and 2. The test
// covers random states, both directions, and small and large steps.
TEST(ActuatorInverse, SolvesFromRandomStates) {
  const unsigned seed = 99;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> pressure(0, 60);
  for (const double exponent : {1.0, 2.0}) {
    model::Model body = body_of(model_named("bench_twin"));
    const auto place = model::find_path(body, "bouc_wen.exponent");
    ASSERT_TRUE(place);
    auto values = model::flat_values(body);
    values[*place] = exponent;
    body = model::with_values(body, values);
    ActuatorInverse inverse(body, tick_s);
    model::Chain<double> finger(body, {}, tick_s);
    for (int k = 0; k < 3000; ++k) {
      const double hidden =
          random() % 3 == 0 ? pressure(random) : inverse.pressure_kpa() + 1e-3 * (k % 7 - 3);
      const double inside = std::clamp(hidden, 0.0, 60.0);
      const double wanted = inverse.displacement_at(inside);
      const auto solution = inverse.solve(wanted, 0, 60);
      ASSERT_NEAR(inverse.displacement_at(solution.pressure_kpa), wanted, 1e-10) << "step " << k;
      ASSERT_NEAR(solution.pressure_kpa, inside, 1e-7) << "step " << k;
      inverse.advance(solution.pressure_kpa);
    }
  }
}

// Tests 60 random fingers for which a Newton step can overshoot the solution. Each finger has a curvature of
// either sign and two stops.
TEST(ActuatorInverse, SolvesAcrossKinksFromRandomStates) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> pressure(0, 60), curvature(-4, 4), place(0, 12);
  for (int finger = 0; finger < 60; ++finger) {
    SCOPED_TRACE(finger);
    model::Model body = body_of(model_named("bench_twin"));
    body = model::with_block(
        body, model::block_of<model::Characteristic>({{"curvature", curvature(random)}, {"span_mm", 12}}));
    for (const double stiffening : {3.0, 100.0}) {
      body = model::with_block(body, model::block_of<model::Contact>(
                                         {{"position_mm", place(random)}, {"stiffening", stiffening}}));
    }
    ActuatorInverse inverse(body, tick_s);
    for (int k = 0; k < 200; ++k) {
      const double wanted = inverse.displacement_at(pressure(random));
      const auto solution = inverse.solve(wanted, 0, 60);
      ASSERT_TRUE(solution.reached) << k;
      ASSERT_NEAR(inverse.displacement_at(solution.pressure_kpa), wanted, 1e-9) << k;
      inverse.advance(k % 3 == 0 ? solution.pressure_kpa : pressure(random));
    }
  }
}

// The slope of the actuator has a kink at the present pressure, because a change of direction begins there.
// The iteration does not check its last step, so the last step must not cross the kink.
TEST(ActuatorInverse, SolvesExactlyCloseToADirectionChange) {
  ActuatorInverse inverse(body_of(model_named("bench_twin")), tick_s);
  for (const double pressure : {20.0, 40.0 - 2e-6, 40.0 - 1e-6, 40.0}) inverse.advance(pressure);
  for (const double turn : {1e-6, 4e-6, 1e-5, 1.5e-5}) {
    const double wanted = inverse.displacement_at(40 - turn);
    EXPECT_NEAR(inverse.displacement_at(inverse.solve(wanted, 0, 60).pressure_kpa), wanted, 2e-11) << turn;
  }
}

TEST(ActuatorInverse, AnUnreachableReferenceGivesTheBoundWithoutWindUp) {
  const model::Model body = body_of(model_named("bench_twin"));
  ActuatorInverse inverse(body, tick_s);
  for (int k = 0; k < 400; ++k) inverse.advance(0.15 * std::min(k, 300));
  // After the vent, creep keeps the finger above 0 mm for some seconds. In these seconds, no pressure can
  // move the finger to 0 mm.
  int out_of_reach = 0;
  for (int k = 0; k < 4000; ++k) {
    const auto solution = inverse.solve(k < 3000 ? 0 : 5, 0, 60);
    if (!solution.reached) {
      ++out_of_reach;
      ASSERT_EQ(solution.pressure_kpa, 0);
    }
    inverse.advance(solution.pressure_kpa);
    if (k >= 3000) {
      ASSERT_NEAR(inverse.displacement_mm(), 5, 1e-9)
          << "the inverse reaches the reference in the first tick because it starts from the true state";
    }
  }
  EXPECT_GT(out_of_reach, 1000);
  const auto high = inverse.solve(500, 0, 60);
  EXPECT_FALSE(high.reached);
  EXPECT_EQ(high.pressure_kpa, 60);
}

// The explicit inverse p[k] = (y[k] + h[k-1]) / alpha is common in the literature. It is a fixed-point
// iteration for the pressure p, with the displacement y and the hysteretic state h. Near h = 0, the loop gain
// of the iteration is beta/alpha, which is 2.43 for the published model. The iteration therefore diverges
// until the hysteretic state saturates. When the reference changes its direction, the iteration diverges
// without bound.
struct ExplicitInverse {
  double alpha, beta, gamma, eta;
  double p_kpa = 0, h_mm = 0;
  void step(double wanted_mm) {
    const double next = (wanted_mm + h_mm) / alpha;
    const double change = next - p_kpa;
    h_mm += beta * change - gamma * change * std::abs(h_mm) - eta * std::abs(change) * h_mm;
    p_kpa = next;
  }
};

TEST(ActuatorInverse, TheExplicitMultiplicativeInverseDiverges) {
  ExplicitInverse published{0.07079, 0.17207, 0.02093, 0.02};
  published.step(0.01);
  const double first = published.p_kpa;
  for (int k = 0; k < 5; ++k) published.step(0.01);
  EXPECT_GT(published.p_kpa, std::pow(2.4, 5) * first) << "the reference is constant at 0.01 mm";
  for (int k = 0; k < 34; ++k) published.step(0.01);
  EXPECT_GT(published.p_kpa, 50);
  for (int k = 0; k < 40; ++k) published.step(0.009);
  EXPECT_FALSE(std::abs(published.p_kpa) < 1e6) << "the reference is 1 um below the previous reference";

  // For bench_twin, beta/alpha is 0.81, so the iteration converges. However, each tick removes only a fifth
  // of the remaining error, so the computed pressure lags behind a ramp of the reference.
  ExplicitInverse twin{0.21105, 0.1713, 0.01625, 0.02428};
  for (int k = 0; k <= 60; ++k) twin.step(0.01 * k);
  EXPECT_NEAR(twin.alpha * twin.p_kpa - twin.h_mm, 0.6, 0.1);
  EXPECT_GT(std::abs(twin.alpha * twin.p_kpa - twin.h_mm - 0.6), 0.003);
}

}  // namespace
}  // namespace softgrip::control::actuator_inverse_test
