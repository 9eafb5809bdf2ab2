#include "daemon/loop/loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include "daemon/service/daemon_parts.h"
#include "tests/daemon/rig_under_test.h"

namespace softgrip::daemon::loop_test {
namespace {

using control::FaultCode;
using control::State;

/// Tests the control loop in virtual time. The test runs the components of the daemon itself.
class LoopTest : public ::testing::Test {
 protected:
  LoopTest() {
    DaemonOptions options;
    options.virtual_time = true;
    rig::RigFile rig = testing::example_rig("rig.yaml");
    rig.recorder.mode = rig::RecorderSettings::Mode::off;
    parts_ = std::make_unique<DaemonParts>(std::move(rig), options);
    due_ = parts_->origin;
  }
  /// Runs one tick of the loop. The tick begins at its scheduled time plus `late`.
  void tick(Nanoseconds late = 0) {
    parts_->virtual_clock.set(due_ + late);
    parts_->loop.tick(due_);
    due_ += parts_->period();
  }
  void exchange() {
    parts_->virtual_clock.set(due_ - parts_->period() + parts_->bus_offset());
    parts_->bus.step(parts_->virtual_clock.now());
  }
  bool until(State state) {
    for (int i = 0; i < 10'000; ++i) {
      tick();
      exchange();
      parts_->service.pump();
      parts_->recorder.drain();
      if (snapshot().state == state) return true;
    }
    return false;
  }
  const Snapshot& snapshot() { return parts_->service.snapshot(); }

  std::unique_ptr<DaemonParts> parts_;
  Nanoseconds due_ = 0;
};

TEST_F(LoopTest, EveryTickSendsCommandsASnapshotAndARowPerChannel) {
  tick();
  EXPECT_TRUE(parts_->shared.commands.fetch());
  EXPECT_EQ(snapshot().ticks, 1U);
  EXPECT_EQ(snapshot().channel_count, 2U);
  std::vector<Record> records(32);
  records.resize(parts_->shared.records.pop(records));
  EXPECT_EQ(records.size(), 2U);
  EXPECT_EQ(records.back().channel, 1);
}

TEST_F(LoopTest, WakeUpLatencyIsMeasuredFromTheSchedule) {
  tick(250'000);
  EXPECT_EQ(parts_->loop_statistics.wake_up.summary().max_ns, 250'000);
}

TEST_F(LoopTest, ComputeTimeStartsAtWakeUpAndAgeAtFirstReading) {
  tick();
  EXPECT_EQ(parts_->loop_statistics.reading_age.summary().count, 0U);
  EXPECT_EQ(parts_->loop_statistics.compute.summary().max_ns, 0) << "no virtual time passes in a tick";
  exchange();
  tick();
  EXPECT_EQ(parts_->loop_statistics.reading_age.summary().count, 1U);
}

TEST_F(LoopTest, InputsNotReadForTooLongCauseAFault) {
  ASSERT_TRUE(until(State::idle));
  parts_->shared.inputs.longest_silence = 10 * parts_->period();
  parts_->shared.inputs.looked_at = due_;
  tick();
  exchange();
  EXPECT_EQ(snapshot().state, State::idle);
  for (int i = 0; i < 12; ++i) {
    tick();
    exchange();
  }
  EXPECT_EQ(snapshot().state, State::faulted);
  EXPECT_EQ(snapshot().first_fault.code, FaultCode::inputs_lost);
}

TEST_F(LoopTest, InputsReportedLostCauseAFaultAtOnce) {
  ASSERT_TRUE(until(State::idle));
  parts_->shared.inputs.longest_silence = 1'000 * parts_->period();
  parts_->shared.inputs.looked_at = due_;
  parts_->shared.inputs.lost = true;
  tick();
  EXPECT_EQ(snapshot().state, State::faulted);
}

TEST_F(LoopTest, DroppedRowsAreCountedAndEventsAreKept) {
  const std::size_t capacity = parts_->shared.records.capacity();
  for (std::size_t i = 0; i < capacity; ++i) {
    tick();
    exchange();
    parts_->service.pump();
  }
  EXPECT_GT(parts_->shared.records_dropped.load(), capacity / 2);
  const std::size_t before = parts_->shared.records_dropped.load();
  parts_->shared.inputs.emergency_stop.store(true);
  tick();
  EXPECT_GT(parts_->shared.records_dropped.load(), before);
  Broadcast<StampedEvent>::Reader reader(parts_->shared.events);
  std::vector<control::Event::Kind> kinds;
  for (StampedEvent event; reader.pop(event);) kinds.push_back(event.event.kind);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), control::Event::Kind::fault_latched), 1);
}

TEST_F(LoopTest, AnExchangeThatHangsIsAFaultAfterTheConfiguredCycles) {
  ASSERT_TRUE(until(State::idle));
  const auto cycles = parts_->rig.settings.faults.bus_down_cycles;
  ASSERT_LT(cycles * parts_->period(), nanoseconds(parts_->rig.settings.channels[0].plausibility.max_age_s));
  tick();  // in this tick, the loop still has the report of the last successful exchange
  tick();  // in this tick, the loop tolerates the missing report as jitter
  for (std::uint32_t i = 0; i < cycles; ++i) {
    EXPECT_EQ(snapshot().state, State::idle) << i;
    tick();
  }
  EXPECT_EQ(snapshot().state, State::faulted);
  EXPECT_EQ(snapshot().first_fault.code, FaultCode::bus_down);
}

TEST_F(LoopTest, ACutWireStopsMotionUntilAcknowledgedAndStartedAgain) {
  ASSERT_TRUE(until(State::idle));
  parts_->service.submit(control::Request::Kind::start,
                         testing::example_sequence(parts_->rig, "pick_stone.yaml"));
  ASSERT_TRUE(until(State::running));
  for (int i = 0; i < 200; ++i) {
    tick();
    exchange();
  }
  ASSERT_GT(snapshot().channels[0].command_kpa, 1);
  auto& board = dynamic_cast<simulation::SimulatedBoard&>(*parts_->board);
  simulation::SimulatedEvent cut;
  cut.kind = simulation::SimulatedEvent::Kind::bus_lost;
  board.happen(cut);
  const std::uint64_t before = parts_->loop_statistics.ticks.value();
  ASSERT_TRUE(until(State::faulted));
  EXPECT_LE(parts_->loop_statistics.ticks.value() - before, parts_->rig.settings.faults.bus_down_cycles + 1);
  simulation::SimulatedEvent mended;
  mended.kind = simulation::SimulatedEvent::Kind::bus_restored;
  board.happen(mended);
  for (int i = 0; i < 1000; ++i) {
    tick();
    exchange();
    parts_->service.pump();
    parts_->recorder.drain();
    ASSERT_EQ(snapshot().state, State::faulted);
  }
  EXPECT_TRUE(snapshot().bus.connected);
  EXPECT_EQ(snapshot().channels[0].command_kpa, 0) << "the rig file specifies vent for the closing phase";
  parts_->service.submit(control::Request::Kind::acknowledge);
  ASSERT_TRUE(until(State::idle));
  EXPECT_EQ(snapshot().channels[0].command_kpa, 0) << "no finger moves without a command";
}

TEST_F(LoopTest, TheShutdownSendsSafeOutputsAsLastCommands) {
  ASSERT_TRUE(until(State::idle));
  parts_->service.submit(control::Request::Kind::start,
                         testing::example_sequence(parts_->rig, "pick_stone.yaml"));
  ASSERT_TRUE(until(State::running));
  for (int i = 0; i < 200; ++i) {
    tick();
    exchange();
  }
  ASSERT_GT(snapshot().channels[0].command_kpa, 1);
  parts_->loop.leave();
  ASSERT_TRUE(parts_->shared.commands.fetch());
  EXPECT_TRUE(parts_->shared.commands.value().last);
  EXPECT_EQ(parts_->shared.commands.value().command_kpa[0], 0);
}

TEST_F(LoopTest, DecimationRecordsEveryNthTick) {
  rig::RigFile rig = testing::example_rig("rig.yaml");
  rig.recorder.decimation = 10;
  DaemonOptions options;
  options.virtual_time = true;
  DaemonParts parts(std::move(rig), options);
  for (int i = 0; i < 100; ++i) parts.loop.tick(parts.virtual_clock.now());
  std::vector<Record> records(1000);
  records.resize(parts.shared.records.pop(records));
  EXPECT_EQ(records.size(), 20U);
}

TEST(LoopThread, MissedCyclesAreCountedAndReportedToTheController) {
  rig::RigFile rig = testing::example_rig("rig.yaml");
  rig.settings.faults.overrun_cycles = 10;
  DaemonParts parts(std::move(rig), {});
  parts.bus.open();
  // The schedule starts 100 periods in the past, so the first tick is very late. The loop must skip the
  // missed ticks.
  const Nanoseconds now = parts.clock.now();
  std::thread loop([&] { parts.loop.run(PeriodicSchedule(now - 100 * parts.period(), parts.period())); });
  sleep_until(now + 3 * parts.period());
  parts.shared.shutdown_requested.store(true);
  loop.join();
  EXPECT_GE(parts.loop_statistics.overruns_woken_late.value(), 100U);
  EXPECT_LE(parts.loop_statistics.ticks.value(), 10U) << "the loop must not repeat missed ticks";
  EXPECT_EQ(parts.service.snapshot().first_fault.code, FaultCode::cycles_lost);
}

}  // namespace
}  // namespace softgrip::daemon::loop_test
