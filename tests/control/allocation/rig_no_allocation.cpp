// A tick of the whole rig allocates nothing, in any state. A program of its own: it replaces operator new, in
// the form that does not throw too, which the standard library's algorithms use.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <vector>

#include "tests/control/rig_fixture.h"

namespace {
thread_local bool counting = false;
thread_local std::size_t allocations = 0;

void* counted(std::size_t size) noexcept {
  allocations += counting ? 1U : 0U;
  return std::malloc(size == 0 ? 1 : size);
}
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = counted(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}

namespace softgrip::control {
namespace {

TEST(TickAllocation, TheHookCounts) {
  counting = true;
  const std::vector<int> kept(100);
  counting = false;
  EXPECT_EQ(allocations, 1U) << kept.size();
}

TEST(TickAllocation, NoneInAnyState) {
  const RigSettings settings = two_finger_settings();
  SimulatedRig rig(settings);
  rig.around_tick = [](bool begins) { counting = begins; };
  rig.stone(12);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  const PreparedSequence track = example_sequence("track_sine", settings);
  const PreparedSequence profile = example_sequence("pressure_staircase", settings);
  allocations = 0;
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
  EXPECT_EQ(allocations, 0U);
}

// Planned motion, the grip that is not planned for (backing off), another start.
TEST(TickAllocation, NoneOfAPlan) {
  RigSettings settings = two_finger_settings();
  for (ChannelSettings& channel : settings.channels) channel.feedforward.kind = FeedforwardKind::planned;
  SimulatedRig rig(settings);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_NE(pick.steps[0].plan_of(0), nullptr);
  rig.around_tick = [](bool begins) { counting = begins; };
  allocations = 0;
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  for (int i = 0; i < 2; ++i) {
    rig.request(Request::Kind::start, &pick);
    ASSERT_TRUE(rig.run_until(State::running, 12));
    rig.run(9);
    rig.request(Request::Kind::stop);
    rig.run(15);
  }
  EXPECT_EQ(allocations, 0U);
}

}  // namespace
}  // namespace softgrip::control
