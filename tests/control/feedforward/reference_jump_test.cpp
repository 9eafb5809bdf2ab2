// Tests the feedforward `full_model` after a jump of the reference, after a disturbance, and after ticks
// without a reference.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "control/feedforward/feedforward_kinds.h"
#include "model/named.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::reference_jump_test {
namespace {

using sim::model_named;
using sim::tick_s;

constexpr LimitSettings usual_limits{0, 60, 400, 400, 0, 25, 1};

/// Returns bench_twin with a displacement that is `factor` times larger at each pressure.
model::Model twin_times(double factor) {
  const model::Model twin = model_named("bench_twin");
  auto values = model::flat_values(twin);
  for (const char* name : {"bouc_wen.alpha_mm_per_kpa", "bouc_wen.beta_mm_per_kpa"})
    values[model::find_path(twin, name).value()] *= factor;
  for (const char* name :
       {"kelvin_voigt.k0_kpa_per_mm", "kelvin_voigt.k1_kpa_per_mm", "kelvin_voigt.c1_kpa_s_per_mm",
        "kelvin_voigt.k2_kpa_per_mm", "kelvin_voigt.c2_kpa_s_per_mm"})
    values[model::find_path(twin, name).value()] /= factor;
  return model::with_values(twin, values);
}

/// Simulates a finger that equals the model. The feedforward follows `reference` from rest.
struct Follower {
  Follower(const model::Model& model, const Reference& followed, const LimitSettings& limits = usual_limits,
           double step_s = tick_s)
      : reference(followed),
        duration_s(step_s),
        feedforward(model, {FeedforwardKind::full_model, 0}, limits, step_s),
        finger(model, {}, step_s) {
    feedforward.enter(RunningModel(model, step_s, 0, std::max(0.1, step_s)), query(), 0);
  }

  [[nodiscard]] FeedforwardQuery query() const { return {&reference, time_s(), offset_mm}; }
  [[nodiscard]] double time_s() const { return ticks * duration_s; }

  /// Runs one tick. The command of the tick is in `command_kpa`.
  void tick() {
    command_kpa = feedforward.step(query()).pressure_kpa;
    move();
  }
  /// Runs one tick without a reference.
  void hold() {
    feedforward.hold();
    move();
  }
  void move() {
    finger.step(0, command_kpa);
    finger.step(duration_s, command_kpa);
    ++ticks;
  }

  const Reference& reference;
  double duration_s;
  Feedforward feedforward;
  model::Chain<double> finger;
  double command_kpa = 0;
  double offset_mm = 0;
  int ticks = 0;
};

/// Counts the changes of direction of a signal. Movements up to `least` are ignored.
struct Turns {
  double least;
  double direction = 0;
  int count = 0;
  void add(double increment) {
    if (std::abs(increment) <= least) return;
    count += increment * direction < 0 ? 1 : 0;
    direction = increment;
  }
};

/// Returns a reference that goes from rest to `from_mm`, rests, and jumps to `to_mm` at 6 s. The reference is
/// in the middle of the jump for `middle_s`, as after an interpolation between two samples.
Reference jump(double from_mm, double to_mm, double middle_s = 0) {
  Reference reference;
  reference.start(0, 0);
  (void)reference.ramp_for(from_mm, 1);
  (void)reference.hold_for(5);
  if (middle_s > 0) (void)reference.sine((from_mm + to_mm) / 2, 0, 1 / middle_s, 1);
  (void)reference.sine(to_mm, 0, 0.1, 1);
  return reference;
}

// The pressure may pass its last value and return, because the finger creeps. This is one change of
// direction. Further changes are an oscillation.
void expect_no_oscillation(double rate_hz, double factor, double size, double middle_s) {
  SCOPED_TRACE(std::to_string(rate_hz) + " Hz, factor " + std::to_string(factor) + ", jump by " +
               std::to_string(size) + ", middle for " + std::to_string(middle_s) + " s");
  const double to = 10 * factor + size;
  const Reference reference = jump(10 * factor, to, middle_s);
  Follower follower(twin_times(factor), reference, {0, 100, 400, 400, 0, 40 * factor, 1}, 1 / rate_hz);
  Turns turns{.least = 0.2};
  double beyond = 0;
  while (follower.time_s() < 14) {
    const double before_kpa = follower.command_kpa;
    follower.tick();
    if (follower.time_s() < 5.5) continue;
    turns.add(follower.command_kpa - before_kpa);
    beyond = std::max(beyond, (follower.finger.reading_mm() - to) * (size > 0 ? 1 : -1));
  }
  EXPECT_LE(turns.count, 1);
  EXPECT_LT(beyond, 0.03);
  EXPECT_NEAR(follower.finger.reading_mm(), to, 0.02);
}

TEST(ReferenceJump, CausesNoOscillationAtAnyRateAndSpan) {
  for (const double rate_hz : {20.0, 50.0, 200.0}) {
    for (const double factor : {1.0, 10.0}) {
      for (const double size : {0.6, 1.5, 4.0, -0.6, -1.5}) {
        expect_no_oscillation(rate_hz, factor, size, 0);
        expect_no_oscillation(rate_hz, factor, 2 * size, 1 / rate_hz);
      }
    }
  }
}

TEST(ReferenceJump, CausesNoOscillationAtAnySlewLimit) {
  const model::Model twin = model_named("bench_twin");
  const Reference reference = jump(6, 12);
  for (const double slew : {60.0, 120.0, 400.0}) {
    SCOPED_TRACE(slew);
    Follower follower(twin, reference, {0, 60, slew, slew, 0, 25, 1});
    Turns turns{.least = 1e-3};
    double highest = 0;
    while (follower.time_s() < 12) {
      const double before_kpa = follower.command_kpa;
      const double before_mm = follower.finger.reading_mm();
      follower.tick();
      ASSERT_LE(std::abs(follower.command_kpa - before_kpa), slew * tick_s * (1 + 1e-9))
          << "the command changes by no more than the slew limits permit";
      highest = std::max(highest, follower.finger.reading_mm());
      turns.add(follower.finger.reading_mm() - before_mm);
    }
    EXPECT_LT(highest, 12.02);
    EXPECT_EQ(turns.count, 0);
    EXPECT_NEAR(follower.finger.reading_mm(), 12, 2e-3);
  }
}

// The reference jumps from 0 to 8 mm, and the finger must reach 8 mm within a time limit. A finger with an
// elastic and a creeping element moves with the element that needs less pressure. A finger without creep
// moves with its elastic element.
TEST(ReferenceJump, OfEightMillimetresIsFollowedWithinOneSecond) {
  const model::Model twin = model_named("bench_twin");
  struct Case {
    const char* name;
    model::Model model;
    double within_s;
  };
  for (const Case& test :
       {Case{"creeping", twin, 0.8},
        Case{"elastic", model::without_block(twin, *model::find_block("kelvin_voigt")), 0.9}}) {
    SCOPED_TRACE(test.name);
    Reference reference;
    reference.start(0, 0);
    (void)reference.hold_for(0.5);
    (void)reference.sine(8, 0, 0.2, 1);  // the reference jumps from 0 to 8 mm
    Follower follower(test.model, reference);
    while (follower.time_s() < 0.5 + test.within_s) follower.tick();
    EXPECT_NEAR(follower.finger.reading_mm(), 8, 0.02);
  }
}

// If a disturbance displaces the finger during a motion, the command must not jump. The finger must continue
// its motion and gradually return to the reference.
TEST(ReferenceJump, ADisplacementOffsetInMotionCausesNoCommandJump) {
  Reference reference;
  reference.start(0, 0);
  (void)reference.hold_for(0.2);
  (void)reference.ramp_for(16, 2);
  Follower follower(model_named("bench_twin"), reference);
  double before = 0, last = 0, worst = 0;
  while (follower.time_s() < 1.8) {
    // In the middle of the ramp, simulate a displacement that exceeds the prediction of the model by 2 mm.
    if (follower.time_s() > 1.1) follower.offset_mm = 2;
    follower.tick();
    if (follower.time_s() > 0.7) worst = std::max(worst, std::abs(follower.command_kpa - 2 * last + before));
    before = last;
    last = follower.command_kpa;
  }
  EXPECT_LT(worst, 0.5) << "largest difference between two consecutive changes of the command [kPa]";
}

// While the command is held, the finger still moves. After the gap, the finger returns to the reference and
// follows it exactly, so the state of the feedforward is again the state of the finger.
TEST(TicksWithoutAReference, TheStateOfTheFullModelFollowsTheFinger) {
  for (const double gap_s : {0.005, 0.1, 1.0, 5.0}) {
    SCOPED_TRACE(gap_s);
    Reference reference;
    reference.start(0, 0);
    (void)reference.ramp_for(3, 1);
    (void)reference.hold_for(1);
    (void)reference.ramp_for(15, 2);
    (void)reference.hold_for(20);
    Follower follower(model_named("bench_twin"), reference);
    while (follower.time_s() < 2.7) follower.tick();
    const double held_kpa = follower.command_kpa;
    while (follower.time_s() < 2.7 + gap_s) follower.hold();
    Turns turns{.least = 0.1};
    double worst_mm = 0, highest_mm = 0;
    follower.tick();
    EXPECT_NEAR(follower.command_kpa, held_kpa, 400 * tick_s);
    while (follower.time_s() < 2.7 + gap_s + 3) {
      const double before_kpa = follower.command_kpa;
      follower.tick();
      turns.add(follower.command_kpa - before_kpa);
      highest_mm = std::max(highest_mm, follower.finger.reading_mm());
      if (follower.time_s() > 2.7 + gap_s + 1.3) {
        const double wanted_mm = reference.at(follower.time_s()).value;
        worst_mm = std::max(worst_mm, std::abs(follower.finger.reading_mm() - wanted_mm));
      }
    }
    EXPECT_LT(worst_mm, 2e-3);
    EXPECT_LT(highest_mm, 15.02);
    EXPECT_LE(turns.count, 1);
  }
}

// A gap in a fade-out: the reference is constant, but the fade-out that was planned before the gap is over
// after it. The feedforward must start a new fade-out.
TEST(TicksWithoutAReference, AGapInAFadeOutCausesNoOscillation) {
  const Reference reference = jump(6, 14);
  Follower follower(model_named("bench_twin"), reference);
  while (follower.time_s() < 6) follower.tick();
  for (int k = 0; k < 100; ++k) follower.hold();
  Turns turns{.least = 0.1};
  double highest_mm = 0, fastest_kpa = 0;
  while (follower.time_s() < 10) {
    const double before_kpa = follower.command_kpa;
    follower.tick();
    turns.add(follower.command_kpa - before_kpa);
    fastest_kpa = std::max(fastest_kpa, std::abs(follower.command_kpa - before_kpa));
    highest_mm = std::max(highest_mm, follower.finger.reading_mm());
  }
  EXPECT_LE(turns.count, 1);
  EXPECT_LT(fastest_kpa, 400 * tick_s) << "the command changes more slowly than the slew limit permits";
  EXPECT_LT(highest_mm, 14.02);
  EXPECT_NEAR(follower.finger.reading_mm(), 14, 2e-3);
}

}  // namespace
}  // namespace softgrip::control::reference_jump_test
