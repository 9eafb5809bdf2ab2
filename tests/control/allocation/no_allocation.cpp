// Tests that a tick of the controller of one channel allocates no memory, in any state of the channel.

#include <gtest/gtest.h>

#include <vector>

#include "control/feedforward/feedforward_kinds.h"
#include "control/tick/channel_controller.h"
#include "tests/control/simulated_finger.h"
#include "tests/support/allocation_counter.h"

namespace softgrip::control {
namespace {

using Mode = ChannelDemand::Mode;

TEST(ChannelControllerAllocation, TheCounterDetectsAnAllocation) {
  std::vector<int> kept;
  EXPECT_GT(test::allocations_of([&] { kept.resize(100); }), 0U);
}

TEST(ChannelControllerAllocation, NoTickAllocates) {
  for (const FeedforwardKind kind :
       {FeedforwardKind::none, FeedforwardKind::bouc_wen, FeedforwardKind::full_model}) {
    ChannelSettings settings = sim::twin_settings();
    settings.feedforward.kind = kind;
    ChannelController controller(settings, sim::tick_s);
    ChannelOutput output;
    controller.start(0, output);
    sim::SimulatedFinger finger(settings.model, 0.02, 3);
    ChannelInput input;
    Reference reference;
    const std::size_t before = test::allocations();
    test::count_allocations(true);
    for (int k = 1; k < 20000; ++k) {
      input.now = k * sim::tick_ns;
      if (k % 500 == 0) {
        input.demand.mode = static_cast<Mode>(k / 500 % 4);
        input.demand.pressure_kpa = k % 60;
        input.demand.reference = &reference;
        input.resynchronise = k % 1500 == 0;
        reference.start(k * sim::tick_s, 3);
        (void)reference.ramp_to(15, 20);
      }
      if (k % 3000 == 0) controller.start(0, output);
      if (k % 700 == 0) input.now += 7 * sim::tick_ns;
      input.demand.time_s = k * sim::tick_s;
      controller.tick(input, output);
      test::count_allocations(false);  // stop counting, because the simulated finger may allocate memory
      input.reading = finger.write(output.command_kpa, input.now);
      test::count_allocations(true);
    }
    test::count_allocations(false);
    EXPECT_EQ(test::allocations(), before) << "feedforward " << static_cast<int>(kind);
  }
}

// The library starts a feedforward again at any time: it resets the running model and assigns a feedforward
// of the same model, also after enter(), step() and hold().
TEST(FeedforwardAllocation, ANewStartAllocatesNothing) {
  const ChannelSettings settings = sim::twin_settings();
  for (const FeedforwardKind kind :
       {FeedforwardKind::none, FeedforwardKind::bouc_wen, FeedforwardKind::full_model}) {
    const Feedforward at_rest(settings.model, {kind, 0}, settings.limits, sim::tick_s);
    Feedforward feedforward = at_rest;
    RunningModel running(settings.model, sim::tick_s, 0, sim::tick_s);
    Reference reference;
    reference.start(0, 3);
    FeedforwardQuery query{.reference = &reference};
    const auto run = [&] {
      for (int start = 0; start < 3; ++start) {
        running.reset(5.0 * start);
        feedforward = at_rest;
        feedforward.enter(running, query, 5.0 * start);
        for (int k = 0; k < 300; ++k) {
          (void)feedforward.step(query);
          if (k % 10 == 0) feedforward.hold();
        }
      }
    };
    EXPECT_EQ(test::allocations_of(run), 0U) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace softgrip::control
