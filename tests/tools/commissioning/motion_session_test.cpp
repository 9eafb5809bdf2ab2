// Tests manual motion with a board that vents after its watchdog time. The disturbances are pauses of the
// process, lost requests and refused writes.

#include "tools/commissioning/motion_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "rig/rig_file.h"
#include "tests/daemon/rig_under_test.h"
#include "tests/daemon/scripted_lines.h"

namespace softgrip::tools::motion_session_test {
namespace {

using drivers::BusStatus;
using Kind = MotionFailure::Kind;

constexpr Nanoseconds never = std::numeric_limits<Nanoseconds>::max();
constexpr Nanoseconds ms = ns_per_s / 1000;
constexpr Nanoseconds watchdog = 500 * ms;
constexpr Nanoseconds deadline = 50 * ms;
constexpr double pressure_kpa = 30;
constexpr double speed_kpa_per_s = 12;
/// Largest difference between two pressures that differ only by rounding [kPa].
constexpr double equal_kpa = 1e-9;

/// A clock that advances only in sleep_until() and pass(). The first sleep that ends at or after `pause_at`
/// takes longer by `pause`, as if the process had been paused.
class StoppableClock final : public Clock {
 public:
  [[nodiscard]] Nanoseconds now() const noexcept override { return now_; }
  void sleep_until(Nanoseconds due) const noexcept override {
    now_ = std::max(now_, due);
    if (now_ < pause_at) return;
    now_ += pause;
    pause_at = never;
  }
  void pass(Nanoseconds duration) const noexcept { now_ += duration; }

  mutable Nanoseconds pause_at = never;
  Nanoseconds pause = 0;

 private:
  mutable Nanoseconds now_ = ns_per_s;
};

/// A board that holds its outputs until its watchdog time expires. Any request restarts the watchdog time.
/// Any write ends a watchdog trip.
class VentingBoard final : public drivers::Board {
 public:
  explicit VentingBoard(const StoppableClock& clock) : clock_(clock) {}

  [[nodiscard]] std::size_t channels() const noexcept override { return 2; }
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds) noexcept override {
    ++sessions;
    const bool gone =
        how == BusStatus::disconnected && clock_.now() >= lost_from && clock_.now() < lost_until;
    if (gone) clock_.pass(connect_takes);
    return gone ? how : next_connect;
  }
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<model::Reading> readings,
                                   std::chrono::nanoseconds limit) noexcept override {
    if (on_exchange) on_exchange();
    const bool lost = clock_.now() >= lost_from && clock_.now() < lost_until;
    const BusStatus status = lost ? how : BusStatus::ok;
    if (!lost || request_arrives) take(commands_kpa);
    if (status == BusStatus::timed_out) clock_.pass(limit.count());
    if (status != BusStatus::ok) return status;
    for (std::size_t i = 0; i < readings.size(); ++i) {
      readings[i].sampled_at = clock_.now();
      readings[i].validity = validity;
      readings[i].displacement_mm = outputs_kpa[i] / 3 + crept_mm;
      readings[i].pressure_kpa =
          monitored ? outputs_kpa[i] * monitor_gain + monitor_offset_kpa : std::nan("");
      ++readings[i].sequence;
    }
    return BusStatus::ok;
  }
  [[nodiscard]] const char* detail() const noexcept override { return "scripted"; }
  [[nodiscard]] std::string describe() const override { return "a board that vents"; }
  [[nodiscard]] Budget budget() const override { return {}; }
  [[nodiscard]] bool has_watchdog() const noexcept override { return watchdog_ns > 0; }
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override {
    return std::chrono::nanoseconds(watchdog_ns);
  }
  /// Vents the outputs if the watchdog time has expired.
  void advance() noexcept {
    if (watchdog_ns == 0 || fed_at_ == 0 || clock_.now() - fed_at_ < watchdog_ns) return;
    std::fill(outputs_kpa.begin(), outputs_kpa.end(), 0.0);
    vented = true;
  }

  Nanoseconds watchdog_ns = watchdog;
  BusStatus next_connect = BusStatus::ok;
  Nanoseconds connect_takes = 0;      ///< duration of a failed attempt to connect [ns]
  std::function<void()> on_exchange;  ///< function to call before a request reaches the board
  Nanoseconds lost_from = never;      ///< time from which exchanges fail [ns]
  Nanoseconds lost_until = never;     ///< time from which exchanges succeed again [ns]
  BusStatus how = BusStatus::timed_out;
  bool request_arrives = false;  ///< true: in a failed exchange, the request has arrived, and only the
                                 ///< response is lost
  model::Validity validity = model::Validity::valid;
  double crept_mm = 0;      ///< additional displacement of the fingers [mm]
  double monitor_gain = 1;  ///< measured pressure divided by the output
  double monitor_offset_kpa = 0;
  bool monitored = true;  ///< false: the pressure monitors give no readings

  std::vector<double> outputs_kpa{0, 0};
  double largest_rise_kpa = 0;  ///< largest increase of an output by a single write [kPa]
  double highest_after_vent_kpa = 0;
  bool vented = false;
  int sessions = 0;

 private:
  void take(std::span<const double> commands_kpa) noexcept {
    advance();
    fed_at_ = clock_.now();
    for (std::size_t i = 0; i < outputs_kpa.size(); ++i) {
      largest_rise_kpa = std::max(largest_rise_kpa, commands_kpa[i] - outputs_kpa[i]);
      if (vented) highest_after_vent_kpa = std::max(highest_after_vent_kpa, commands_kpa[i]);
      outputs_kpa[i] = commands_kpa[i];
    }
  }

  const StoppableClock& clock_;
  Nanoseconds fed_at_ = 0;
};

class MotionSessionTest : public ::testing::Test {
 protected:
  MotionSessionTest() {
    rig_.loop.exchange_deadline_s = seconds(deadline);
    // 80 failed cycles last longer than the watchdog time. In these tests, the session therefore ends because
    // of the duration of the gap, before 80 cycles have failed.
    rig_.settings.faults.bus_down_cycles = 80;
  }
  [[nodiscard]] StopRequest stop() {
    return [this] { return clock_.now() >= stop_at_; };
  }
  /// Raises the pressure, holds it for 1 s and lowers it, as `softgrip calibrate` does.
  MotionSession::Expected<void> move(MotionSession& session) {
    if (auto connected = session.connect(); !connected) return connected;
    if (auto up = session.ramp(0, pressure_kpa, speed_kpa_per_s); !up) return up;
    if (auto there = session.sample(1); !there) return tl::unexpected(there.error());
    return session.ramp(0, 0, speed_kpa_per_s);
  }
  /// Returns the largest change of a command in one cycle at the requested speed [kPa].
  [[nodiscard]] double step_kpa() const { return speed_kpa_per_s / rig_.settings.rate_hz + equal_kpa; }

  rig::RigFile rig_ = daemon::testing::example_rig("rig.yaml");
  StoppableClock clock_;
  VentingBoard board_{clock_};
  Nanoseconds stop_at_ = never;
};

TEST_F(MotionSessionTest, LimitsTheSlewRateAndEndsAtTheRestPressure) {
  {
    MotionSession session(rig_, board_, clock_, stop());
    ASSERT_TRUE(session.connect());
    ASSERT_TRUE(session.ramp(0, pressure_kpa, 1e9));
    EXPECT_DOUBLE_EQ(board_.outputs_kpa[0], pressure_kpa);
    EXPECT_EQ(board_.outputs_kpa[1], 0);
    EXPECT_EQ(session.command_kpa(0), board_.outputs_kpa[0]);
    const control::LimitSettings& limits = rig_.settings.channels[0].limits;
    EXPECT_LE(board_.largest_rise_kpa, limits.slew_up_kpa_per_s / rig_.settings.rate_hz + equal_kpa);
  }
  EXPECT_EQ(board_.outputs_kpa[0], 0) << "the destructor writes the rest pressure";
}

TEST_F(MotionSessionTest, LeavingRaisesAVacuumToRestWithinTheSlewLimit) {
  rig_ = daemon::testing::example_rig("vacuum/rig.yaml");
  MotionSession session(rig_, board_, clock_, stop());
  ASSERT_TRUE(session.connect());
  ASSERT_TRUE(session.sample(0.1));
  EXPECT_EQ(board_.outputs_kpa[0], 0) << "the first write is the rest pressure";
  ASSERT_TRUE(session.ramp(0, -30, 1e9));
  EXPECT_DOUBLE_EQ(board_.outputs_kpa[0], -30);
  board_.largest_rise_kpa = 0;
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
  const control::LimitSettings& limits = rig_.settings.channels[0].limits;
  EXPECT_LE(board_.largest_rise_kpa, limits.slew_up_kpa_per_s / rig_.settings.rate_hz + equal_kpa);
}

TEST_F(MotionSessionTest, APauseUnderVacuumEndsTheMotionAtTheRestPressure) {
  rig_ = daemon::testing::example_rig("vacuum/rig.yaml");
  rig_.settings.faults.bus_down_cycles = 80;
  MotionSession session(rig_, board_, clock_, stop());
  ASSERT_TRUE(session.connect());
  ASSERT_TRUE(session.ramp(0, -30, speed_kpa_per_s));
  clock_.pass(2 * watchdog);
  const auto after = session.sample(1);
  ASSERT_FALSE(after);
  EXPECT_EQ(after.error().kind, Kind::bus);
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
}

/// Tests pauses at many times during the motion. No pause is shorter than the watchdog time.
TEST_F(MotionSessionTest, APauseOfTheWatchdogTimeEndsTheMotionWithoutAPressureRise) {
  const Nanoseconds begin = clock_.now();
  for (const Nanoseconds pause : {500 * ms, 501 * ms, 800 * ms, 1200 * ms, 60'000 * ms}) {
    for (Nanoseconds at = 40 * ms; at < 5500 * ms; at += 173 * ms) {
      SCOPED_TRACE("pause of " + std::to_string(pause / ms) + " ms after " + std::to_string(at / ms) + " ms");
      StoppableClock clock;
      VentingBoard board(clock);
      MotionSession session(rig_, board, clock, [] { return false; });
      clock.pause = pause;
      clock.pause_at = begin + at;
      const auto moved = move(session);
      ASSERT_FALSE(moved);
      EXPECT_EQ(moved.error().kind, Kind::bus);
      EXPECT_NE(moved.error().text.find("the board's own watchdog vents the outputs after 0.500 s"),
                std::string::npos)
          << moved.error().text;
      EXPECT_TRUE(board.vented);
      EXPECT_EQ(board.highest_after_vent_kpa, 0);
      EXPECT_LE(board.largest_rise_kpa, step_kpa());
      EXPECT_FALSE(session.ramp(0, pressure_kpa, speed_kpa_per_s))
          << "a session that has ended must not move a finger";
      EXPECT_FALSE(session.sample(0.1));
      EXPECT_TRUE(session.leave());
      EXPECT_EQ(board.highest_after_vent_kpa, 0);
    }
  }
}

TEST_F(MotionSessionTest, APauseBelowTheWatchdogTimeCausesNoLargerStep) {
  const Nanoseconds begin = clock_.now();
  for (Nanoseconds at = 40 * ms; at < 5500 * ms; at += 173 * ms) {
    SCOPED_TRACE(at / ms);
    StoppableClock clock;
    VentingBoard board(clock);
    MotionSession session(rig_, board, clock, [] { return false; });
    clock.pause = 440 * ms;
    clock.pause_at = begin + at;
    EXPECT_TRUE(move(session));
    EXPECT_FALSE(board.vented);
    EXPECT_LE(board.largest_rise_kpa, step_kpa());
  }
}

/// A program cannot detect a pause between its last reading of the clock and its write. The session must
/// therefore detect the pause after this write and return to the rest pressures immediately.
TEST_F(MotionSessionTest, APauseDuringAnExchangeEndsTheMotionAfterTheExchange) {
  MotionSession session(rig_, board_, clock_, stop());
  ASSERT_TRUE(session.connect());
  bool paused = false;
  double before_kpa = 0;
  board_.on_exchange = [&] {
    if (paused || clock_.now() < 2 * ns_per_s) return;
    paused = true;
    before_kpa = board_.outputs_kpa[0];
    clock_.pass(1200 * ms);
  };
  const auto moved = session.ramp(0, pressure_kpa, speed_kpa_per_s);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().text.find("no successful exchange with the board for 1.20"), std::string::npos)
      << moved.error().text;
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
  EXPECT_LE(board_.highest_after_vent_kpa, before_kpa + step_kpa())
      << "after the vent of the board, at most one further step of the command may be written";
}

TEST_F(MotionSessionTest, RequestsLostBeyondTheWatchdogTimeEndTheMotionWithoutRise) {
  for (const BusStatus how : {BusStatus::timed_out, BusStatus::disconnected, BusStatus::bad_reply}) {
    for (Nanoseconds at = 40 * ms; at < 5000 * ms; at += 171 * ms) {
      SCOPED_TRACE(std::string(drivers::name_of(how)) + " after " + std::to_string(at / ms) + " ms");
      StoppableClock clock;
      VentingBoard board(clock);
      board.how = how;
      board.lost_from = clock.now() + at;
      board.lost_until = board.lost_from + 700 * ms;
      MotionSession session(rig_, board, clock, [] { return false; });
      const auto moved = move(session);
      ASSERT_FALSE(moved);
      EXPECT_EQ(moved.error().kind, Kind::bus);
      EXPECT_TRUE(session.leave()) << "the board responds again";
      EXPECT_EQ(board.highest_after_vent_kpa, 0);
      EXPECT_EQ(board.outputs_kpa[0], 0);
      EXPECT_LE(board.largest_rise_kpa, step_kpa());
    }
  }
}

/// The requests arrive, so the board holds its outputs. The responses are lost, so the session cannot know
/// that the requests arrive. The session must therefore end the motion.
TEST_F(MotionSessionTest, RepliesThatAreLostForLongerThanTheWatchdogEndTheMotion) {
  board_.lost_from = clock_.now() + 1500 * ms;
  board_.lost_until = board_.lost_from + 700 * ms;
  board_.request_arrives = true;
  MotionSession session(rig_, board_, clock_, stop());
  const auto moved = move(session);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().kind, Kind::bus);
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
  EXPECT_LE(board_.largest_rise_kpa, step_kpa());
}

TEST_F(MotionSessionTest, AShortCommunicationLossCausesNoLargerStep) {
  for (const bool arrives : {false, true}) {
    StoppableClock clock;
    VentingBoard board(clock);
    board.request_arrives = arrives;
    board.lost_from = clock.now() + 1500 * ms;
    board.lost_until = board.lost_from + 160 * ms;
    MotionSession session(rig_, board, clock, [] { return false; });
    ASSERT_TRUE(move(session)) << arrives;
    EXPECT_GT(board.sessions, 1) << "a session was opened again";
    EXPECT_LE(board.largest_rise_kpa, step_kpa());
    EXPECT_FALSE(board.vented);
  }
}

TEST_F(MotionSessionTest, ALongLossWithoutAWatchdogEndsTheMotion) {
  board_.watchdog_ns = 0;
  rig_.settings.faults.bus_down_cycles = 20;
  board_.lost_from = clock_.now() + 1500 * ms;
  MotionSession session(rig_, board_, clock_, stop());
  const auto moved = move(session);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().text, "scripted");
  const Nanoseconds before = clock_.now();
  EXPECT_FALSE(session.leave()) << "the board did not confirm the rest pressure";
  EXPECT_LT(clock_.now() - before, 3 * ns_per_s) << "the session must end within its deadline";
}

TEST_F(MotionSessionTest, APauseOnABoardWithoutAWatchdogMakesNoLargerStep) {
  board_.watchdog_ns = 0;
  clock_.pause_at = clock_.now() + 1500 * ms;
  clock_.pause = 60 * ns_per_s;
  MotionSession session(rig_, board_, clock_, stop());
  EXPECT_TRUE(move(session)) << "without a watchdog the board holds its outputs";
  EXPECT_LE(board_.largest_rise_kpa, step_kpa());
}

TEST_F(MotionSessionTest, AnOutputFaultReportedByTheBoardEndsTheMotion) {
  for (const BusStatus said :
       {BusStatus::write_refused, BusStatus::overwritten, BusStatus::watchdog_tripped}) {
    SCOPED_TRACE(drivers::name_of(said));
    StoppableClock clock;
    VentingBoard board(clock);
    board.how = said;
    board.lost_from = clock.now() + 1500 * ms;
    board.lost_until = board.lost_from + 1;
    MotionSession session(rig_, board, clock, [] { return false; });
    const auto moved = move(session);
    ASSERT_FALSE(moved);
    EXPECT_EQ(moved.error().kind, Kind::bus);
    EXPECT_NE(moved.error().text.find("scripted"), std::string::npos) << moved.error().text;
    EXPECT_TRUE(session.leave());
    EXPECT_EQ(board.outputs_kpa[0], 0);
  }
}

TEST_F(MotionSessionTest, DoesNotRaiseThePressureBeforeRequiredReadingsAreValid) {
  for (const Sight sight : {Sight{0, true, false}, Sight{0, false, true}, Sight{0, true, true}}) {
    StoppableClock clock;
    VentingBoard board(clock);
    board.validity = model::Validity::sensor_error;
    board.monitored = false;
    MotionSession session(rig_, board, clock, [] { return false; });
    session.require(sight);
    const auto moved = move(session);
    ASSERT_FALSE(moved);
    EXPECT_EQ(moved.error().kind, Kind::blind);
    EXPECT_NE(moved.error().text.find("of `left`"), std::string::npos) << moved.error().text;
    EXPECT_NE(moved.error().text.find("are not valid"), std::string::npos) << moved.error().text;
    EXPECT_EQ(board.largest_rise_kpa, 0);
  }
}

TEST_F(MotionSessionTest, LosingARequiredReadingEndsTheMotionWithinItsCycleLimit) {
  for (const bool displacement : {true, false}) {
    StoppableClock clock;
    VentingBoard board(clock);
    const Nanoseconds lost_at = clock.now() + 1500 * ms;
    double stood_kpa = 0;  // output after the last exchange with readings of both sensors [kPa]
    bool first_status = true;
    board.on_exchange = [&] {
      if (clock.now() < lost_at) return;
      if (std::exchange(first_status, false)) stood_kpa = board.outputs_kpa[0];
      if (displacement) board.validity = model::Validity::out_of_range;
      board.monitored = displacement;
    };
    MotionSession session(rig_, board, clock, [] { return false; });
    session.require({0, displacement, !displacement});
    const auto moved = move(session);
    ASSERT_FALSE(moved);
    EXPECT_EQ(moved.error().kind, Kind::blind);
    EXPECT_NE(moved.error().text.find(displacement ? "displacement sensor" : "pressure monitor"),
              std::string::npos)
        << moved.error().text;
    EXPECT_LE(board.outputs_kpa[0], stood_kpa + rig_.settings.faults.invalid_reading_cycles * step_kpa());
    EXPECT_TRUE(session.leave());
    EXPECT_EQ(board.outputs_kpa[0], 0);
  }
}

TEST_F(MotionSessionTest, SingleInvalidReadingsDoNotEndTheMotion) {
  int exchanges = 0;
  board_.on_exchange = [&] {
    board_.validity = ++exchanges % 7 == 0 ? model::Validity::out_of_range : model::Validity::valid;
  };
  MotionSession session(rig_, board_, clock_, stop());
  session.require({0, true, false});
  EXPECT_TRUE(move(session));
}

TEST_F(MotionSessionTest, AFingerThatCreepsBeyondItsLimitsEndsTheMotion) {
  MotionSession session(rig_, board_, clock_, stop());
  ASSERT_TRUE(session.connect());
  board_.crept_mm = 1000;
  EXPECT_TRUE(session.sample(0.1)) << "no finger was moved";
  board_.crept_mm = 0;
  ASSERT_TRUE(session.ramp(0, pressure_kpa, speed_kpa_per_s));
  ASSERT_TRUE(session.sample(0.1));
  board_.crept_mm = 1000;
  const auto creeping = session.sample(600);
  ASSERT_FALSE(creeping);
  EXPECT_EQ(creeping.error().kind, Kind::beyond);
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
}

/// The limit of the rig file is 60 kPa, and the monitor shows up to 90 kPa.
TEST_F(MotionSessionTest, AMeasuredPressureAboveTheLimitEndsTheMotion) {
  board_.monitor_gain = 3;
  MotionSession session(rig_, board_, clock_, stop());
  const auto moved = move(session);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().kind, Kind::pressure);
  EXPECT_NE(moved.error().text.find("the pressure monitor of `left` shows"), std::string::npos)
      << moved.error().text;
  EXPECT_NE(moved.error().text.find("Either the points of the valve or the points of the pressure monitor"),
            std::string::npos)
      << moved.error().text;
  EXPECT_LT(board_.outputs_kpa[0] * board_.monitor_gain, 72);
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
}

TEST_F(MotionSessionTest, AShortOvershootOfThePressureDoesNotEndTheMotion) {
  const Nanoseconds begin = clock_.now();
  board_.on_exchange = [&] {
    const bool overshoots = clock_.now() > begin + 2 * ns_per_s && clock_.now() < begin + 2050 * ms;
    board_.monitor_gain = overshoots ? 10 : 1;
  };
  MotionSession session(rig_, board_, clock_, stop());
  EXPECT_TRUE(move(session));
}

TEST_F(MotionSessionTest, ThePressureIsNotJudgedBeforeAMotion) {
  board_.monitor_offset_kpa = 100;
  MotionSession session(rig_, board_, clock_, stop());
  ASSERT_TRUE(session.connect());
  EXPECT_TRUE(session.sample(1));
}

/// Tests that a session leaves in time if the board disappears and each attempt to connect takes 2 s.
class LeavingTest : public MotionSessionTest {
 protected:
  LeavingTest() {
    board_.connect_takes = 2 * ns_per_s;
    board_.how = BusStatus::disconnected;
    rig_.reconnect.connect_deadline = std::chrono::seconds(2);
    rig_.settings.rate_hz = 40;
    rig_.settings.faults.bus_down_cycles = 5;
    for (control::ChannelSettings& channel : rig_.settings.channels) channel.limits.slew_down_kpa_per_s = 5;
  }
  /// Raises the pressure and leaves after the board has disappeared. The board returns after `gone`. Returns
  /// the duration of leave() [s].
  double leave(Nanoseconds gone = 3600 * ns_per_s) {
    MotionSession session(rig_, board_, clock_, stop());
    EXPECT_TRUE(session.connect());
    EXPECT_TRUE(session.ramp(0, pressure_kpa, speed_kpa_per_s));
    const Nanoseconds begin = clock_.now();
    board_.lost_from = begin;
    board_.lost_until = begin + gone;
    confirmed_ = session.leave([&](const std::string& why) {
      ++told_;
      told_after_s_ = seconds(clock_.now() - begin);
      EXPECT_EQ(why, "scripted");
    });
    return seconds(clock_.now() - begin);
  }

  bool confirmed_ = true;
  int told_ = 0;
  double told_after_s_ = 0;
};

TEST_F(LeavingTest, TheRampFollowsTheTimeWhileTheBoardIsGone) {
  board_.watchdog_ns = 0;
  constexpr double ramp_s = pressure_kpa / 5;
  EXPECT_LT(leave(), ramp_s + 1 + 2 + 0.2) << "ramp, confirmation and one attempt to connect";
  EXPECT_FALSE(confirmed_);
  EXPECT_EQ(told_, 1);
  EXPECT_LT(told_after_s_, 2.2) << "the report follows the first failed attempt to connect";
}

TEST_F(LeavingTest, ABoardThatReturnsReceivesTheRestPressure) {
  board_.watchdog_ns = 0;
  EXPECT_LT(leave(3 * ns_per_s), 6.5);
  EXPECT_TRUE(confirmed_);
  EXPECT_EQ(board_.outputs_kpa[0], 0);
}

TEST_F(LeavingTest, TheRestPressuresFollowAtOnceAfterTheWatchdogTime) {
  EXPECT_LT(leave(), 0.5 + 1 + 2 * 2 + 0.2) << "without the watchdog, the ramp alone takes 6 s";
  EXPECT_FALSE(confirmed_);
  EXPECT_EQ(told_, 1);
}

/// Tests rigs with an emergency stop and an enable output.
class MotionLinesTest : public MotionSessionTest {
 protected:
  MotionLinesTest() {
    rig_.gpio.emplace();
    rig_.gpio->lines.resize(2);
    rig_.gpio->lines[0].role = GpioRole::emergency_stop;
    rig_.gpio->lines[1].role = GpioRole::enable;
  }
  using GpioRole = drivers::GpioRole;

  daemon::testing::Terminals terminals_;
  std::unique_ptr<drivers::GpioLines> lines_ = terminals_.lines();
};

TEST_F(MotionLinesTest, AnEmergencyStopDuringARampWritesTheRestPressureAtOnce) {
  const Nanoseconds pressed_at = clock_.now() + 1500 * ms;
  int exchanges = 0;
  board_.on_exchange = [&] {
    ++exchanges;
    if (clock_.now() >= pressed_at) terminals_.set(GpioRole::emergency_stop, true);
  };
  MotionSession session(rig_, board_, clock_, stop(), lines_.get());
  const auto moved = move(session);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().kind, Kind::emergency_stop);
  EXPECT_NE(moved.error().text.find("the emergency stop is pressed"), std::string::npos);
  EXPECT_FALSE(terminals_.level(GpioRole::enable)) << "an emergency stop switches the enable output off";
  EXPECT_GT(board_.outputs_kpa[0], 10) << "the command had begun to rise before the emergency stop";
  exchanges = 0;
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
  EXPECT_EQ(exchanges, 1) << "an emergency stop does not ramp the pressure down";
}

TEST_F(MotionLinesTest, AnEmergencyStopDuringTheReturnWritesTheRestPressureAtOnce) {
  for (control::ChannelSettings& channel : rig_.settings.channels) channel.limits.slew_down_kpa_per_s = 5;
  MotionSession session(rig_, board_, clock_, stop(), lines_.get());
  ASSERT_TRUE(session.connect());
  ASSERT_TRUE(session.ramp(0, pressure_kpa, speed_kpa_per_s));
  terminals_.set(GpioRole::emergency_stop, true);
  const Nanoseconds begin = clock_.now();
  EXPECT_TRUE(session.leave());
  EXPECT_LT(clock_.now() - begin, 100 * ms);
  EXPECT_EQ(board_.outputs_kpa[0], 0);
}

TEST_F(MotionLinesTest, NothingMovesIfTheEmergencyStopIsPressedOrCannotBeRead) {
  const auto refusal = [&](drivers::GpioLines* lines) {
    MotionSession session(rig_, board_, clock_, stop(), lines);
    EXPECT_TRUE(session.connect());
    EXPECT_TRUE(session.sample(0.1)) << "the sensors can be read";
    const auto moved = session.ramp(0, pressure_kpa, speed_kpa_per_s);
    EXPECT_FALSE(moved);
    EXPECT_EQ(moved.error().kind, Kind::emergency_stop);
    EXPECT_TRUE(session.leave());
    return moved.error().text;
  };
  terminals_.set(GpioRole::emergency_stop, true);
  EXPECT_NE(refusal(lines_.get()).find("is pressed"), std::string::npos);
  terminals_.set(GpioRole::emergency_stop, false);
  EXPECT_NE(refusal(nullptr).find("cannot be read"), std::string::npos);
  terminals_.fail();
  EXPECT_NE(refusal(lines_.get()).find("cannot be read"), std::string::npos);
  rig_.gpio->lines.erase(rig_.gpio->lines.begin());
  EXPECT_NE(refusal(lines_.get()).find("the enable output cannot be switched on"), std::string::npos);
  EXPECT_EQ(board_.largest_rise_kpa, 0);
}

TEST_F(MotionLinesTest, TheEnableOutputIsOnFromTheFirstRampUntilTheSessionIsLeft) {
  MotionSession session(rig_, board_, clock_, stop(), lines_.get());
  ASSERT_TRUE(session.connect());
  ASSERT_TRUE(session.sample(0.1));
  EXPECT_FALSE(terminals_.level(GpioRole::enable));
  bool enabled_with_pressure = true;
  board_.on_exchange = [&] {
    if (board_.outputs_kpa[0] > 0) enabled_with_pressure &= terminals_.level(GpioRole::enable);
  };
  ASSERT_TRUE(session.ramp(0, pressure_kpa, speed_kpa_per_s));
  EXPECT_TRUE(session.leave());
  EXPECT_TRUE(enabled_with_pressure);
  EXPECT_FALSE(terminals_.level(GpioRole::enable));
}

TEST_F(MotionSessionTest, AStopByTheUserEndsTheMotionAtTheRestPressure) {
  stop_at_ = clock_.now() + 1500 * ms;
  MotionSession session(rig_, board_, clock_, stop());
  const auto moved = move(session);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().kind, Kind::stopped);
  EXPECT_GT(board_.outputs_kpa[0], 1) << "the command had begun to rise before the stop";
  EXPECT_TRUE(session.leave());
  EXPECT_EQ(board_.outputs_kpa[0], 0);
}

TEST_F(MotionSessionTest, ErrorNamesTheUnreachableBoard) {
  board_.next_connect = BusStatus::disconnected;
  MotionSession session(rig_, board_, clock_, stop());
  const auto connected = session.connect();
  ASSERT_FALSE(connected);
  EXPECT_EQ(connected.error().text, "a board that vents: scripted");
}

}  // namespace
}  // namespace softgrip::tools::motion_session_test
