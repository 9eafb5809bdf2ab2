// Tests that the invariants of the rig hold for random requests and random faults. A failed test prints its
// seed. To repeat the failure, set SOFTGRIP_SEED to this seed.

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::rig_random_test {
namespace {

class Chaos {
 public:
  explicit Chaos(std::uint64_t seed) : random_(seed), settings_(make_settings(seed)), rig_(settings_, seed) {
    for (const char* name :
         {"pick_stone", "pick_screw", "empty_grip", "track_sine", "pressure_staircase", "hand_over"}) {
      sequences_.push_back(example_sequence(name, settings_));
    }
    if (settings_.channels[0].limits.pressure_min_kpa < 0) sequences_.push_back(vacuum_grip(settings_));
  }

  void run(int ticks) {
    for (int i = 0; i < ticks && !testing::Test::HasFailure(); ++i) {
      if (chance(0.01)) {
        change_the_world();
      }
      const Request::Kind asked = chance(0.01) ? ask() : Request::Kind::none;
      step(asked);
    }
  }

  [[nodiscard]] const SimulatedRig& rig() const { return rig_; }

 private:
  bool chance(double probability) { return std::bernoulli_distribution(probability)(random_); }
  template <class Number>
  Number any(Number lowest, Number highest) {
    return std::uniform_int_distribution<Number>(lowest, highest)(random_);
  }

  /// Returns random settings. Every third rig allows pressures above and below its rest pressure. Every sixth
  /// rig has a rest pressure of 10 kPa.
  RigSettings make_settings(std::uint64_t seed) {
    RigSettings settings = seed % 3 == 0 ? vacuum_settings() : two_finger_settings();
    if (seed % 6 == 0) {
      for (ChannelSettings& channel : settings.channels) channel.limits.rest_kpa = 10;
    }
    for (SafeAction& action : settings.safety.safe_action) {
      action = chance(0.5) ? SafeAction::vent : SafeAction::hold;
    }
    settings.safety.on_emergency_stop = chance(0.5) ? SafeAction::vent : SafeAction::hold;
    settings.faults.overrun_cycles = chance(0.5) ? 5 : 0;
    settings.rest_timeout_s = 3;
    return settings;
  }

  /// Changes the injected faults at random. Most calls remove all faults, so that sequences can continue.
  void change_the_world() {
    rig_.wire_cut = chance(0.05);
    rig_.emergency_stop = chance(0.05);
    rig_.interlock_open = chance(0.1);
    rig_.bus_fault = chance(0.05) ? FaultCode::bus_bad_reply : FaultCode::none;
    rig_.overrun_cycles = chance(0.05) ? 10 : 0;
    for (auto& channel : rig_.fault) {
      channel = {};
      if (chance(0.05)) {
        channel.validity = static_cast<model::Validity>(any(0, 6));
      }
      if (chance(0.03)) {
        channel.offset_mm = any(-20, 20);
      }
      if (chance(0.03)) {
        channel.readback_offset_kpa = any(-20, 20);
      }
    }
    if (chance(0.3)) {
      rig_.stone(chance(0.5) ? std::optional<double>(any(6, 14)) : std::nullopt);
    }
  }

  Request::Kind ask() {
    const auto kind = chance(0.5) ? Request::Kind::start : static_cast<Request::Kind>(any(1, 6));
    rig_.request(kind, &sequences_[any<std::size_t>(0, sequences_.size() - 1)]);
    return kind;
  }

  void step(Request::Kind asked) {
    const TickOutput before = rig_.output();
    const std::size_t told = rig_.events.size();
    const TickOutput& now = rig_.tick();  // SimulatedRig checks the commands of the tick
    if (before.state == State::faulted && now.state != State::faulted) {
      EXPECT_EQ(asked, Request::Kind::acknowledge) << "at " << rig_.time_s();
    }
    if (before.state == State::faulted && now.state == State::faulted) {
      EXPECT_EQ(before.first_fault.code, now.first_fault.code);
    }
    EXPECT_EQ(now.state == State::faulted, now.first_fault.code != FaultCode::none);
    if (now.state == State::running && before.state != State::running) {
      EXPECT_EQ(before.state, State::resynchronising);
    }
    if (now.state == State::resynchronising && before.state != State::resynchronising) {
      EXPECT_EQ(asked, Request::Kind::start);
    }
    bool answered = asked == Request::Kind::none;
    for (std::size_t i = told; i < rig_.events.size(); ++i) {
      answered = answered || rig_.events[i].request == rig_.last_request();
    }
    EXPECT_TRUE(answered) << "request " << static_cast<int>(asked) << " at " << rig_.time_s();
  }

  std::mt19937_64 random_;
  RigSettings settings_;
  SimulatedRig rig_;
  std::vector<PreparedSequence> sequences_;
};

TEST(RandomRig, InvariantsHoldForRandomRequestsAndFaults) {
  std::vector<std::uint64_t> seeds;
  if (const char* given = std::getenv("SOFTGRIP_SEED")) {
    seeds.push_back(std::stoull(given));
  } else {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      seeds.push_back(seed);
    }
  }
  std::size_t grips = 0;
  std::size_t faults = 0;
  std::size_t starts = 0;
  for (const std::uint64_t seed : seeds) {
    SCOPED_TRACE("SOFTGRIP_SEED=" + std::to_string(seed));
    Chaos chaos(seed);
    chaos.run(20'000);
    grips += chaos.rig().count(Event::Kind::grip_result);
    faults += chaos.rig().count(Event::Kind::fault_latched);
    starts += chaos.rig().count(Event::Kind::sequence_started);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
  }
  if (seeds.size() > 1) {  // with several seeds, grips, faults and starts must have occurred in sufficient
                           // number
    EXPECT_GT(grips, 500U);
    EXPECT_GT(faults, 500U);
    EXPECT_GT(starts, 500U);
  }
}

TEST(RandomRig, IsDeterministic) {
  std::vector<double> commands;
  for (int run = 0; run < 2; ++run) {
    Chaos chaos(7);
    chaos.run(10'000);
    commands.push_back(chaos.rig().output().channels[0].command_kpa);
    commands.push_back(chaos.rig().output().channels[1].residual_mm);
    commands.push_back(static_cast<double>(chaos.rig().events.size()));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(std::to_string(commands[i]), std::to_string(commands[i + 3]));
  }
}

}  // namespace
}  // namespace softgrip::control::rig_random_test
