// Tests the planned feedforward in three cases: the finger follows the plan, the finger deviates from the
// plan, and there is no plan. Also tests each transition from one case to another.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/feedforward/feedforward_kinds.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::planned_feedforward_test {
namespace {

using sim::model_named;
using sim::tick_s;

constexpr LimitSettings limits{0, 60, 400, 400, 0, 25, 1};
constexpr FeedforwardSettings planned{FeedforwardKind::planned, 0};
constexpr double fade_s = 3;

/// Returns a plan that does not fit the model, so that a test recognises its values. The pressure rises from
/// `from_kpa` at `kpa_per_s`. The reference and the displacement of the model are constant at `reference_mm`.
PressurePlan plan_of(double from_kpa, double kpa_per_s, double reference_mm) {
  PressurePlan plan;
  plan.step_s = 0.1;
  for (int i = 0; i <= 100; ++i) {
    plan.pressure_kpa.push_back(from_kpa + kpa_per_s * plan.step_s * i);
    plan.displacement_mm.push_back(reference_mm);
  }
  plan.reference.start(0, reference_mm);
  return plan;
}

class PlannedFeedforwardTest : public testing::Test {
 protected:
  void enter(double command_kpa) {
    feedforward_.enter(RunningModel(model_, tick_s, 0, 0.1), query_, command_kpa);
  }
  /// Returns the feedforward of the present tick and advances the time by one tick.
  FeedforwardStep step() {
    const FeedforwardStep result = feedforward_.step(query_);
    query_.time_s += tick_s;
    return result;
  }
  /// Runs ticks for `duration_s` and returns the feedforward of the last tick.
  FeedforwardStep step_for(double duration_s) {
    for (int i = 0; i + 1 < std::lround(duration_s / tick_s); ++i) (void)step();
    return step();
  }
  /// Returns the pressure that the plan requires now. The command acts after the dead time plus half a tick,
  /// so this is the value of the plan at that later time.
  [[nodiscard]] double on_plan(const PressurePlan& plan) const {
    return plan.at(query_.time_s - query_.plan_origin_s + plan_ahead_s(model_, planned, tick_s));
  }
  [[nodiscard]] double on_line(double displacement_mm) const {
    return settled_line(model_, limits).pressure_kpa(displacement_mm);
  }
  [[nodiscard]] double gain() const { return settled_line(model_, limits).gain_mm_per_kpa; }

  model::Model model_ = model_named("zhang2025");
  Reference reference_;
  Feedforward feedforward_{model_, planned, limits, tick_s};
  FeedforwardQuery query_{&reference_, 0, 0};
};

TEST_F(PlannedFeedforwardTest, FadesFromTheCurrentPressureToThePlan) {
  reference_.start(0, 5);
  const PressurePlan plan = plan_of(20, 2, 5);
  query_.plan = &plan;
  enter(11);
  EXPECT_NEAR(step().pressure_kpa, 11, 1e-9) << "the command has no step";
  double difference = 11 - 20;
  for (int i = 0; i < 700; ++i) {
    const double expected = on_plan(plan);
    const FeedforwardStep now = step();
    const double left = now.pressure_kpa - expected;
    EXPECT_LE(std::abs(left), std::abs(difference) + 1e-9)
        << "the distance between command and plan never increases";
    EXPECT_FALSE(now.out_of_reach);
    difference = left;
  }
  EXPECT_NEAR(difference, 0, 1e-9) << "the command equals the plan after " << fade_s << " s";
}

TEST_F(PlannedFeedforwardTest, AnOffsetIsCorrectedAtTheSettledGain) {
  reference_.start(0, 5);
  const PressurePlan plan = plan_of(20, 0, 5);
  query_.plan = &plan;
  query_.offset_mm = 0.6;
  enter(20);
  EXPECT_NEAR(step_for(fade_s + 1).pressure_kpa, 20 - 0.6 / gain(), 1e-9);
}

TEST_F(PlannedFeedforwardTest, APlanMoreThan1MillimetreOffIsIgnored) {
  reference_.start(0, 5);
  for (const double aside_mm : {0.9, 1.1}) {
    const PressurePlan plan = plan_of(20, 0, 5 + aside_mm);
    query_.plan = &plan;
    enter(20);
    const double expected = aside_mm < 1 ? 20 - aside_mm / gain() : on_line(5);
    EXPECT_NEAR(step_for(fade_s + 1).pressure_kpa, expected, 1e-9) << aside_mm << " mm off the plan";
  }
}

// The plan begins, ends, or is replaced by a plan with another time origin. In each case, the command must be
// continuous.
TEST_F(PlannedFeedforwardTest, AChangeOfThePlanCausesNoCommandStep) {
  reference_.start(0, 5);
  const PressurePlan low = plan_of(8, 0, 5), high = plan_of(30, 1, 5);
  enter(0);
  double last = step_for(fade_s + 1).pressure_kpa;
  EXPECT_NEAR(last, on_line(5), 1e-9);
  for (const auto& [plan, origin_s] :
       {std::pair(&high, 1.0), std::pair(&low, 1.0), std::pair(&high, 1.0), std::pair(&high, 3.5),
        std::pair<const PressurePlan*, double>(nullptr, 0)}) {
    query_.plan = plan;
    query_.plan_origin_s = origin_s;
    const double at_change = step().pressure_kpa;
    EXPECT_NEAR(at_change, last, 1e-9);
    (void)step_for(fade_s + 1);
    const double expected = plan != nullptr ? on_plan(*plan) : on_line(5);
    last = step().pressure_kpa;
    EXPECT_NEAR(last, expected, 1e-9);
  }
}

// Near a jump of the reference, a rounding error of the time can have a large effect. The time of the plan
// can be before the jump although the time of the sequence is after the jump, or vice versa.
TEST_F(PlannedFeedforwardTest, ARoundingErrorOfTheTimeKeepsThePlan) {
  for (const double rounding_s : {-1e-9, 0.0, 1e-9}) {
    SCOPED_TRACE(rounding_s);
    query_ = {&reference_, 0, 0};
    // At its start, the sine jumps from 0 to its lowest value, 5 mm.
    const double jump_s = plan_ahead_s(model_, planned, tick_s);
    reference_.start(0, 0);
    (void)reference_.hold_for(jump_s);
    (void)reference_.sine(5, 0, 0.1, 1);
    PressurePlan plan = plan_of(20, 0, 5);
    plan.reference = reference_;
    query_.plan = &plan;
    query_.plan_origin_s = rounding_s;
    enter(20);
    EXPECT_NEAR(step().pressure_kpa, 20, 1e-6);
    EXPECT_NEAR(step_for(fade_s).pressure_kpa, 20, 1e-6) << "the command equals the plan";
  }
}

TEST_F(PlannedFeedforwardTest, ReportsAReferenceThatIsOutOfReach) {
  reference_.start(0, 5);
  PressurePlan plan = plan_of(20, 0, 5);
  query_.plan = &plan;
  enter(20);
  EXPECT_FALSE(step().out_of_reach);
  std::fill(plan.displacement_mm.begin(), plan.displacement_mm.end(), 5.19);
  EXPECT_FALSE(step().out_of_reach);
  std::fill(plan.displacement_mm.begin(), plan.displacement_mm.end(), 5.21);
  EXPECT_TRUE(step().out_of_reach) << "the error that the plan predicts is larger than the limit";
  query_.plan = nullptr;
  reference_.start(0, 25);
  query_.offset_mm = -10;
  const FeedforwardStep beyond = step_for(fade_s + 1);
  EXPECT_TRUE(beyond.out_of_reach);
  EXPECT_EQ(beyond.pressure_kpa, limits.pressure_max_kpa);
}

}  // namespace
}  // namespace softgrip::control::planned_feedforward_test
