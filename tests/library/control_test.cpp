#include "library/include/softgrip/control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "library/include/softgrip/board.h"
#include "tests/library/finger.h"

namespace softgrip::control_test {
namespace {

using namespace std::chrono_literals;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ControllerSettings settings() {
  ControllerSettings all{.model = bench_twin()};
  all.limits.pressure_max_kpa = 80;
  all.pid.kp_kpa_per_mm = 2.7;
  all.pid.ki_kpa_per_mm_s = 13;
  all.extra_latency_s = 0.005;
  return all;
}

TEST(LibraryControl, FollowsAReferenceOnTheSimulatedBoard) {
  SimulatedFinger finger{.model = bench_twin()};
  finger.noise = 0.03;
  SimulatedBoard board({finger});
  Controller controller(settings());
  Reference reference;
  reference.start(1, 0);
  ASSERT_TRUE(reference.ramp_to(6, 3));
  ASSERT_TRUE(reference.sine(9, 3, 0.1, 2));
  controller.follow(reference);
  ASSERT_EQ(board.connect(1s), BusStatus::ok);
  std::array<double, 1> command_kpa{0};
  std::array<Reading, 1> reading;
  double worst = 0;
  for (int i = 0; i < 200 * 22; ++i) {
    ASSERT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::ok);
    const ControlOutput output = controller.tick(board.now(), reading[0]);
    ASSERT_GE(output.command_kpa, 0);
    ASSERT_LE(output.command_kpa, 80);
    command_kpa[0] = output.command_kpa;
    if (i > 200 * 10) worst = std::max(worst, std::abs(board.displacement(0) - output.reference));
    board.advance(5ms);
  }
  EXPECT_LT(worst, 0.3);
  EXPECT_GT(board.displacement(0), 5);
  controller.vent();
  for (int i = 0; i < 400; ++i) {
    ASSERT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::ok);
    command_kpa[0] = controller.tick(board.now(), reading[0]).command_kpa;
    board.advance(5ms);
  }
  EXPECT_EQ(command_kpa[0], 0);
}

TEST(LibraryControl, LimitsPressureAndSlewRateOfAnyRequest) {
  Limits limits;
  limits.pressure_max_kpa = 50;
  EXPECT_EQ(limit(limits, 80, 50, 0.01).command_kpa, 50);
  EXPECT_TRUE(limit(limits, 80, 50, 0.01).saturated);
  EXPECT_NEAR(limit(limits, 40, 10, 0.01).command_kpa, 13, 1e-12);
  EXPECT_TRUE(limit(limits, nan, 10, 0.01).invalid);
  EXPECT_EQ(limit(limits, nan, 10, 0.01).command_kpa, 10);
  for (const double elapsed_s : {-1.0, -0.005, nan}) {
    SCOPED_TRACE(elapsed_s);
    EXPECT_EQ(limit(limits, 0, 0, elapsed_s).command_kpa, 0);
    EXPECT_EQ(limit(limits, 50, 10, elapsed_s).command_kpa, 10);
    EXPECT_TRUE(limit(limits, 50, 10, elapsed_s).invalid);
  }
}

TEST(LibraryControl, APidContinuesAtTheAlignedCommand) {
  PidSettings gains;
  gains.kp_kpa_per_mm = 1;
  gains.ki_kpa_per_mm_s = 2;
  Pid pid(gains, 0.01);
  pid.align(12);
  EXPECT_NEAR(5 + pid.step(3, 2, 5), 12, 1e-9);
  pid.sent(12);
  EXPECT_GT(5 + pid.step(3, 2, 5), 12);
}

TEST(LibraryControl, APidContinuesAfterAMeasurementThatIsNotANumber) {
  PidSettings gains;
  gains.kp_kpa_per_mm = 1;
  gains.ki_kpa_per_mm_s = 2;
  Limits limits;
  limits.pressure_max_kpa = 50;
  Pid pid(gains, 0.01);
  double command_kpa = 10;
  pid.align(command_kpa);
  for (int i = 0; i < 200; ++i) {
    const double request_kpa = pid.step(3, i == 100 ? nan : 2, 0);
    ASSERT_TRUE(std::isfinite(request_kpa)) << i;
    command_kpa = limit(limits, request_kpa, command_kpa, 0.01).command_kpa;
    pid.sent(command_kpa);
  }
  EXPECT_NEAR(command_kpa, 10 + 2 * 0.01 * 1 * 197, 1e-9) << "the integral stops for two of the 199 periods";
}

TEST(LibraryControl, AReferenceRefusesInvalidSegments) {
  Reference reference(1);
  EXPECT_EQ(reference.at(5), 1);
  EXPECT_FALSE(reference.ramp_to(nan, 1));
  EXPECT_FALSE(reference.ramp_to(2, 0));
  EXPECT_FALSE(reference.hold_for(-1));
  EXPECT_FALSE(reference.sine(1, 1, 0, 1));
  EXPECT_TRUE(reference.ramp_to(2, 1));
  const Reference copy = reference;
  EXPECT_EQ(copy.at(1), 2);
  EXPECT_EQ(copy.end_s(), 1);
  for (int i = 0; i < 7; ++i) EXPECT_TRUE(reference.hold_for(1)) << i;
  EXPECT_FALSE(reference.hold_for(1));
}

TEST(LibraryControl, AReferenceRefusesSegmentsThatAreNotFinite) {
  Reference reference(1e308);
  EXPECT_FALSE(reference.ramp_to(-1e308, 1));
  EXPECT_EQ(reference.at(0.5), 1e308);
  reference.start(0, 0);
  EXPECT_FALSE(reference.ramp_to(5, 1e-120));
  EXPECT_EQ(reference.at(1), 0);
}

TEST(LibraryControl, AReferenceThatIsNotFiniteHoldsTheCommand) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Limits limits;
  limits.pressure_max_kpa = 60;
  for (const FeedforwardKind kind :
       {FeedforwardKind::none, FeedforwardKind::bouc_wen, FeedforwardKind::full_model}) {
    SCOPED_TRACE(static_cast<int>(kind));
    for (const double start_kpa : {5.0, 70.0}) {
      Feedforward feedforward(bench_twin(), limits, 0.005, kind);
      feedforward.start(start_kpa, 1);
      double last_kpa = kind == FeedforwardKind::none ? 0 : std::min(start_kpa, 60.0);
      for (int k = 0; k < 400; ++k) {
        const bool is_missing = k < 3 || k % 50 > 40;
        const double missing = k % 3 == 0 ? nan : k % 3 == 1 ? infinity : -infinity;
        const FeedforwardStep step = feedforward.step(is_missing ? missing : 2 - std::cos(0.02 * k));
        if (is_missing) {
          EXPECT_EQ(step.pressure_kpa, last_kpa) << k;
          EXPECT_TRUE(step.out_of_reach) << k;
        }
        ASSERT_TRUE(step.pressure_kpa >= 0 && step.pressure_kpa <= 60) << k;
        last_kpa = step.pressure_kpa;
      }
    }
  }
}

/// Returns the largest error of a finger that equals the model. The reference moves from 3 to 15 mm in 2 s.
/// Within this motion, it is missing for `gap_s`. Errors count from 1.5 s after the gap on.
double error_after_gap(double gap_s) {
  constexpr double tick_s = 0.005;
  Reference reference(3);
  EXPECT_TRUE(reference.hold_for(4));
  EXPECT_TRUE(reference.ramp_to(15, 2));
  Limits limits;
  limits.pressure_max_kpa = 80;
  Feedforward feedforward(bench_twin(), limits, tick_s);
  feedforward.start(0, reference.at(0));
  Simulator finger(bench_twin(), tick_s);
  const double gap_end_s = 4.7 + gap_s;
  double worst = 0;
  for (int k = 0; k * tick_s < gap_end_s + 4; ++k) {
    const double time_s = k * tick_s;
    const bool is_missing = time_s >= 4.7 && time_s < gap_end_s;
    const double ahead = is_missing ? nan : reference.at(time_s + feedforward.preview_s());
    const double command_kpa = feedforward.step(ahead).pressure_kpa;
    (void)finger.step(0, command_kpa);
    const double moved = finger.step(tick_s, command_kpa);
    if (time_s > gap_end_s + 1.5) worst = std::max(worst, std::abs(moved - reference.at(time_s + tick_s)));
  }
  return worst;
}

TEST(LibraryControl, TheModelOfAFeedforwardMovesWhileTheReferenceIsMissing) {
  const double without_gap = error_after_gap(0);
  EXPECT_LT(without_gap, 0.01);
  for (const double gap_s : {0.05, 1.0, 3.0}) EXPECT_LT(error_after_gap(gap_s), without_gap + 2e-3) << gap_s;
}

TEST(LibraryControl, StartOfAFeedforwardDiscardsThePreviousMotion) {
  Limits limits;
  limits.pressure_max_kpa = 60;
  for (const FeedforwardKind kind : {FeedforwardKind::bouc_wen, FeedforwardKind::full_model}) {
    Feedforward feedforward(bench_twin(), limits, 0.005, kind);
    const auto run = [&] {
      feedforward.start(2, 1);
      std::vector<double> commands_kpa;
      for (int k = 0; k < 300; ++k)
        commands_kpa.push_back(feedforward.step(3 - 2 * std::cos(0.02 * k)).pressure_kpa);
      return commands_kpa;
    };
    const std::vector<double> first = run();
    EXPECT_EQ(run(), first) << static_cast<int>(kind);
    const double last_kpa = first.back();
    feedforward.start(nan, 1);
    feedforward.start(2, std::numeric_limits<double>::infinity());
    EXPECT_EQ(feedforward.step(nan).pressure_kpa, last_kpa) << "a start with such an argument has no effect";
  }
}

TEST(LibraryControl, RefusesATickThatIsTooShortForASimulatedBoard) {
  const std::vector<SimulatedFinger> fingers{{.model = bench_twin()}};
  for (const double tick_s : {0.0, -1.0, 1e-300, 1e-9, 9e-7, nan}) {
    EXPECT_THROW(SimulatedBoard(fingers, tick_s), InvalidArgument) << tick_s;
    if (tick_s != 0) {
      EXPECT_THROW(Simulator(bench_twin(), tick_s), InvalidArgument) << tick_s;
    }
  }
  EXPECT_NO_THROW(SimulatedBoard(fingers, 2e-6));
  EXPECT_NO_THROW(Simulator(bench_twin(), 1e-6));
  EXPECT_NO_THROW(Simulator(bench_twin(), 0));
}

TEST(LibraryControl, RefusesADelayOfTooManyTicksForASimulatedBoard) {
  const SimulatedFinger finger{.model = bench_twin().with("transport_delay.delay_s", 1)};
  EXPECT_NO_THROW(SimulatedBoard({finger}, 1e-5));
  try {
    const SimulatedBoard board({{.model = bench_twin()}, finger}, 0.99e-5);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_EQ(error.argument(), "tick_s");
    EXPECT_NE(std::string(error.what()).find("dead time of bench_twin, which is 1 s"), std::string::npos)
        << error.what();
  }
}

TEST(LibraryControl, RefusesAModelWithoutAnInverse) {
  const Model stiff = Model::load(std::string(SOFTGRIP_SOURCE_DIR) + "/config/models/zhang2025.yaml");
  Limits limits;
  limits.pressure_max_kpa = 50;
  try {
    const Feedforward feedforward(stiff, limits, 0.005);
    FAIL();
  } catch (const Refused& error) {
    EXPECT_NE(std::string(error.what()).find("beta > alpha"), std::string::npos) << error.what();
  }
  ControllerSettings all{.model = stiff};
  all.limits = limits;
  EXPECT_THROW(Controller{all}, Refused);
  all.feedforward = FeedforwardKind::none;
  EXPECT_NO_THROW(Controller{all});
}

TEST(LibraryControl, ErrorNamesTheInvalidSetting) {
  const auto refused = [](auto change) {
    ControllerSettings all = settings();
    change(all);
    try {
      Controller{all};
    } catch (const InvalidArgument& error) {
      return error.argument();
    }
    return std::string();
  };
  EXPECT_EQ(refused([](auto&) {}), "");
  EXPECT_EQ(refused([](auto& s) { s.tick_s = 0; }), "tick_s");
  EXPECT_EQ(refused([](auto& s) { s.reading_max_age_s = 4e9; }), "reading_max_age_s");
  EXPECT_EQ(refused([](auto& s) { s.limits.pressure_max_kpa = -1; }), "pressure_max_kpa");
  EXPECT_EQ(refused([](auto& s) { s.limits.rest_kpa = nan; }), "rest_kpa");
  EXPECT_EQ(refused([](auto& s) { s.pid.kp_kpa_per_mm = nan; }), "kp_kpa_per_mm");
  EXPECT_EQ(refused([](auto& s) { s.pid.tracking_time_s = 0; }), "tracking_time_s");
  EXPECT_EQ(refused([](auto& s) { s.extra_latency_s = 2; }), "extra_latency_s");
  EXPECT_EQ(refused([](auto& s) { s.sensor_noise = 0; }), "sensor_noise");
}

TEST(LibraryBoard, SimulatesObjectsAndRefusesInvalidExchanges) {
  EXPECT_THROW(SimulatedBoard({}), InvalidArgument);
  EXPECT_THROW(SimulatedBoard(std::vector<SimulatedFinger>(17, {.model = bench_twin()})), InvalidArgument);
  SimulatedBoard board({{.model = bench_twin()}});
  std::array<double, 1> command_kpa{30};
  std::array<Reading, 1> reading;
  EXPECT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::disconnected);
  EXPECT_FALSE(board.detail().empty());
  ASSERT_EQ(board.connect(1ms), BusStatus::ok);
  EXPECT_EQ(board.exchange(command_kpa, {}, 1ms), BusStatus::write_refused);
  board.set_object(0, SimulatedObject{2, 0});
  board.set_object(5, SimulatedObject{2, 0});
  for (int i = 0; i < 400; ++i) {
    ASSERT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::ok);
    board.advance(5ms);
  }
  EXPECT_NEAR(board.displacement(0), 2, 1e-4);
  EXPECT_EQ(reading[0].validity, Validity::valid);
  EXPECT_TRUE(std::isnan(board.displacement(1)));
  command_kpa[0] = nan;
  EXPECT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::write_refused);
  EXPECT_EQ(name_of(BusStatus::write_refused), "write_refused");
}

TEST(LibraryBoard, DisplacementAndObjectsApplyAtTheTimeOfTheClock) {
  const auto connected = [](SimulatedBoard& board) {
    const std::array<double, 1> command_kpa{30};
    std::array<Reading, 1> reading;
    EXPECT_EQ(board.connect(1ms), BusStatus::ok);
    EXPECT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::ok);
  };
  SimulatedBoard board({{.model = bench_twin()}});
  connected(board);
  EXPECT_NEAR(board.displacement(0), 0, 0.1);
  board.advance(5s);
  const double moved = board.displacement(0);
  EXPECT_GT(moved, 5);
  const std::array<double, 1> command_kpa{30};
  std::array<Reading, 1> reading;
  ASSERT_EQ(board.exchange(command_kpa, reading, 1ms), BusStatus::ok);
  EXPECT_EQ(board.displacement(0), moved);
  EXPECT_EQ(reading[0].displacement, moved);

  SimulatedBoard blocked({{.model = bench_twin()}});
  connected(blocked);
  blocked.advance(5s);
  blocked.set_object(0, SimulatedObject{2, 0});
  EXPECT_EQ(blocked.displacement(0), moved) << "the object does not move the finger at once";
}

}  // namespace
}  // namespace softgrip::control_test
