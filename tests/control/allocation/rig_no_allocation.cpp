// Tests that a tick of the whole rig allocates no memory, in any state of the rig.

#include <gtest/gtest.h>

#include "tests/control/rig_fixture.h"
#include "tests/support/allocation_counter.h"

namespace softgrip::control {
namespace {

TEST(TickAllocation, NoTickAllocatesMemoryInAnyState) {
  const RigSettings settings = two_finger_settings();
  SimulatedRig rig(settings);
  rig.around_tick = test::count_allocations;
  rig.stone(12);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  const PreparedSequence track = example_sequence("track_sine", settings);
  const PreparedSequence profile = example_sequence("pressure_staircase", settings);
  const std::size_t before = test::allocations();
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  for (const PreparedSequence* sequence : {&pick, &track, &profile}) {
    rig.request(Request::Kind::start, sequence);
    ASSERT_TRUE(rig.run_until(State::running, 12));
    rig.run(20);
    rig.request(Request::Kind::stop);
    rig.run(15);
  }
  rig.request(Request::Kind::start, &pick);
  ASSERT_TRUE(rig.run_until_step(2, 30));
  rig.stone(std::nullopt);
  rig.run(2);
  rig.wire_cut = true;
  rig.run(2);
  rig.wire_cut = false;
  rig.run(1);
  rig.request(Request::Kind::acknowledge);
  rig.run(1);
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_GT(rig.count(Event::Kind::fault_latched), 0U);
  for (int i = 0; i < 20; ++i) {
    rig.fault[0].offset_mm = i % 2 == 0 ? 5 : 0;
    rig.run(0.1);
  }
  EXPECT_EQ(rig.count(Event::Kind::reading_unsteady), 1U);
  EXPECT_EQ(test::allocations(), before);
}

// Tests a motion along a plan, a grip whose second attempt moves back without a plan, and a second start of
// the sequence.
TEST(TickAllocation, NoTickOfAPlannedMotionAllocatesMemory) {
  RigSettings settings = two_finger_settings();
  for (ChannelSettings& channel : settings.channels) channel.feedforward.kind = FeedforwardKind::planned;
  SimulatedRig rig(settings);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_NE(pick.steps[0].plan_of(0), nullptr);
  rig.around_tick = test::count_allocations;
  const std::size_t before = test::allocations();
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  for (int i = 0; i < 2; ++i) {
    rig.request(Request::Kind::start, &pick);
    ASSERT_TRUE(rig.run_until(State::running, 12));
    rig.run(9);
    rig.request(Request::Kind::stop);
    rig.run(15);
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace softgrip::control
