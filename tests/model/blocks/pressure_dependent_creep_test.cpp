#include "model/blocks/pressure_dependent_creep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/blocks/kelvin_voigt.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::pressure_dependent_creep_test {
namespace {

using Block = PressureDependentCreep<double>;

TEST(PressureDependentCreep, CreepsOnlyAboveTheThresholdPressure) {
  Block block = make<Block>({20, 0.05, 2});
  block.step(Segment<double>::straight(0, 0, 19), {});
  block.step(Segment<double>::straight(100, 19, 19), {});
  EXPECT_EQ(block.output(), 0);
  block.step(Segment<double>::straight(0, 19, 30), {});
  block.step(Segment<double>::straight(2, 30, 30), {});
  EXPECT_NEAR(block.output(), 0.05 * 10 * -std::expm1(-1.0), 1e-12);
}

TEST(PressureDependentCreep, EqualsAKelvinVoigtBranchForAZeroThreshold) {
  Block block = make<Block>({0, 0.05, 2});
  auto branch = make<KelvinVoigt<double>>({1e9, 20, 40});
  for (const auto& [from, to] : {std::pair{0.0, 30.0}, {30.0, 5.0}, {5.0, 50.0}}) {
    block.step(Segment<double>::straight(0.3, from, to), {});
    branch.step(Segment<double>::straight(0.3, from, to), {});
    EXPECT_NEAR(block.output(), branch.output(), 1e-7);
  }
}

TEST(PressureDependentCreep, CrossesTheThresholdCorrectlyWithinAStep) {
  Block whole = make<Block>({20, 0.05, 0.5}), parts = make<Block>({20, 0.05, 0.5});
  for (Block* block : {&whole, &parts}) block->step(Segment<double>::straight(0, 0, 10), {});
  for (const auto& [from, to] : {std::pair{10.0, 30.0}, {30.0, 10.0}}) {
    const double foretold = whole.peek(0.02, to, {});
    whole.step(Segment<double>::straight(0.02, from, to), {});
    EXPECT_NEAR(whole.output(), foretold, 1e-14);
    for (int k = 0; k < 1000; ++k) {
      const double a = from + (to - from) * k / 1000, b = from + (to - from) * (k + 1) / 1000;
      parts.step(Segment<double>::straight(0.02 / 1000, a, b), {});
    }
    EXPECT_NEAR(whole.output(), parts.output(), 2e-4 * 0.05 * 10);
  }
}

}  // namespace
}  // namespace softgrip::model::testing::pressure_dependent_creep_test
