// A tick allocates nothing, whatever it does. A program of its own: it replaces operator new.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "control/tick/channel_controller.h"
#include "tests/control/simulated_finger.h"

namespace {
bool armed = false;
long allocations = 0;
}  // namespace

// NOLINTBEGIN(misc-definitions-in-headers): the replacement functions of the language
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (armed) ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
// NOLINTEND(misc-definitions-in-headers)

namespace softgrip::control {
namespace {

using Mode = ChannelDemand::Mode;

TEST(ChannelControllerAllocation, TheHookSeesAnAllocation) {
  armed = true;
  allocations = 0;
  delete new int(1);  // NOLINT(cppcoreguidelines-owning-memory)
  std::vector<int> kept(100);
  armed = false;
  EXPECT_GE(allocations, 1) << kept.size();
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
    armed = true;
    allocations = 0;
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
      armed = false;  // the finger is not what is tested
      input.reading = finger.write(output.command_kpa, input.now);
      armed = true;
    }
    armed = false;
    EXPECT_EQ(allocations, 0) << "feedforward " << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace softgrip::control
