#include "control/feedforward/pressure_plan.h"

#include <gtest/gtest.h>

#include "model/chain.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::pressure_plan_test {
namespace {

TEST(PressurePlan, TheMissIsConstantOutsideThePlan) {
  PressurePlan plan;
  EXPECT_EQ(plan.miss_mm(1), 0) << "the plan is empty";
  plan.step_s = 1;
  plan.start_s = 0;
  plan.displacement_mm = {1, 2, 4};
  plan.reference.start(0, 0);
  EXPECT_EQ(plan.miss_mm(-3), 1);
  EXPECT_EQ(plan.miss_mm(0), 1);
  EXPECT_EQ(plan.miss_mm(1.4), 2);
  EXPECT_EQ(plan.miss_mm(2), 4);
  EXPECT_EQ(plan.miss_mm(9), 4);
}

TEST(SettledLine, PassesThroughTheEndsOfThePressureRange) {
  const model::Model twin = sim::model_named("bench_twin");
  LimitSettings limits{10, 60, 400, 400, 0, 25, 1};
  model::Chain<double> chain(without_dead_time(twin));
  chain.reset(10);
  const double at_lowest_mm = chain.after(model::Station::load);
  chain.reset(60);
  const double at_highest_mm = chain.after(model::Station::load);
  const SettledLine line = settled_line(twin, limits);
  EXPECT_NEAR(line.gain_mm_per_kpa, (at_highest_mm - at_lowest_mm) / 50, 1e-12);
  EXPECT_NEAR(line.pressure_kpa(at_lowest_mm), 10, 1e-9);
  EXPECT_NEAR(line.pressure_kpa(at_highest_mm), 60, 1e-9);
}

// The settled line describes the true position of the finger at rest. It must therefore not depend on the
// dead time, the dead band, the sensor and the noise of the model.
TEST(SettledLine, DoesNotDependOnDeadTimeSensorOrNoise) {
  const model::Model twin = sim::model_named("bench_twin");
  model::Model shown = twin;
  for (const char* name : {"sensor_lag", "sensor_nonlinearity", "sensor_noise", "valve_deadband"}) {
    shown = model::with_block(shown, model::default_block(*model::find_block(name)));
  }
  EXPECT_FALSE(model::position_of(without_dead_time(twin), *model::find_block("transport_delay")));
  EXPECT_EQ(without_dead_time(shown).blocks.size(), without_dead_time(twin).blocks.size());
  const LimitSettings limits{0, 60, 400, 400, 0, 25, 1};
  EXPECT_EQ(settled_line(shown, limits).gain_mm_per_kpa, settled_line(twin, limits).gain_mm_per_kpa);
}

}  // namespace
}  // namespace softgrip::control::pressure_plan_test
