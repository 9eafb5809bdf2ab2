#include "sysid/diagnosis/verdict/loop_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "sysid/diagnosis/residual/closed_loop.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid::loop_phase_test {
namespace {

struct Signals {
  std::vector<double> command, reading;
};

/// Returns the signals of a control loop with a PI controller that keeps the flow through a valve at 0.
/// @param band  change of the command at which the valve breaks free and jumps.
/// @param wave  amplitude of a disturbance of the flow; `period` is its period in samples.
/// @param load  constant flow that the valve must compensate. With a load between two positions of the valve,
/// the valve jumps again and again; otherwise it can rest during the whole record.
Signals loop(double band, double wave, double proportional, double integral, unsigned seed, double load = 0,
             double period = 60) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.01);
  Signals signals;
  double stem = 0.3, flow = 0, sum = 0;
  for (int i = 0; i < 1500; ++i) {
    const double disturbed = flow + load + wave * std::sin(2 * std::numbers::pi * i / period) + noise(random);
    sum += integral * disturbed;
    const double command = -proportional * disturbed - sum;
    if (std::abs(command - stem) > band) stem = command;
    flow += 0.5 * (stem - flow);
    if (i < 300) continue;
    signals.command.push_back(command);
    signals.reading.push_back(disturbed);
  }
  return signals;
}

/// Returns the command and the reading of a finger without feedback. The command was planned before the run,
/// and the finger follows it with a lag.
Signals planned(double lag_share, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.01);
  Signals signals;
  double reading = 0;
  for (int i = 0; i < 1500; ++i) {
    signals.command.push_back(std::sin(2 * std::numbers::pi * i / 100.0) + 0.3 * (i / 70 % 3));
    reading += lag_share * (signals.command.back() - reading);
    signals.reading.push_back(reading + noise(random));
  }
  return signals;
}

TEST(LoopPhase, StictionGivesAnOddCrossCorrelation) {
  int close = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Signals s = loop(0.37, 0, 0.05, 0.03, seed, 0.13);
    EXPECT_TRUE(is_closed_loop(s.command, s.reading)) << seed;
    EXPECT_GT(phase_ratio(s.command, s.reading).value_or(0), 2.0 / 3) << seed;
    const auto stem = shown_stiction(s.command, s.reading);
    ASSERT_TRUE(stem) << seed;
    EXPECT_NEAR(stem->band, 0.37, 0.15) << seed;
    if (std::abs(stem->band - 0.37) < 0.02) ++close;
  }
  EXPECT_GE(close, 5);
}

TEST(LoopPhase, DisturbanceGivesAnEvenCrossCorrelation) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Signals s = loop(0, 1, 0.4, 0.01, seed);
    EXPECT_TRUE(is_closed_loop(s.command, s.reading)) << seed;
    EXPECT_LT(phase_ratio(s.command, s.reading).value_or(1), 1.0 / 3) << seed;
    EXPECT_FALSE(shown_stiction(s.command, s.reading)) << seed;
  }
}

/// Returns the signals of a controller that keeps the level of a tank at 0. The level integrates the
/// difference between the inflow through the valve and the outflow.
/// @param band  change of the command at which the valve breaks free and jumps.
/// @param wave  amplitude of a sinusoidal outflow.
Signals tank(double band, double wave, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.01);
  Signals signals;
  double stem = 0.3, level = 0, sum = 0;
  for (int i = 0; i < 1500; ++i) {
    const double read = level + noise(random);
    sum += 0.02 * read;
    const double command = -0.5 * read - sum;
    if (std::abs(command - stem) > band) stem = command;
    level += 0.2 * (stem - 0.13 - wave * std::sin(2 * std::numbers::pi * i / 80));
    if (i < 300) continue;
    signals.command.push_back(command);
    signals.reading.push_back(read);
  }
  return signals;
}

TEST(LoopPhase, StictionInALevelLoopGivesAPhaseNear180Degrees) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Signals s = tank(0.3, 0, seed);
    EXPECT_TRUE(is_closed_loop(s.command, s.reading)) << seed;
    EXPECT_LT(phase_ratio(s.command, s.reading).value_or(1), limits::even_phase_ratio) << seed;
    const auto stem = shown_stiction(s.command, s.reading);
    ASSERT_TRUE(stem) << seed;
    EXPECT_NEAR(stem->band, 0.3, 0.1) << seed;
    // Command and reading do not rise together, so a fitted response is no other explanation.
    std::vector<double> next(s.reading.begin() + 1, s.reading.end());
    next.push_back(s.reading.back());
    EXPECT_TRUE(shown_stiction(s.command, s.reading, next)) << seed;
    const Signals outflow = tank(0, 0.3, seed);
    EXPECT_TRUE(is_closed_loop(outflow.command, outflow.reading)) << seed;
    EXPECT_FALSE(shown_stiction(outflow.command, outflow.reading)) << seed;
    EXPECT_FALSE(shown_stiction(tank(0, 0.3, seed).command, tank(0, 0.3, seed).reading)) << seed;
  }
}

/// An integrating controller shifts the phase of a slow disturbance by 90 degrees, although the valve is
/// free.
TEST(LoopPhase, AnOddCrossCorrelationOfASlowDisturbanceIsNoStiction) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Signals s = loop(0, 1, 0.02, 0.3, seed);
    const Signals smooth = loop(0, 0.05, 0.4, 0.03, seed, 0, 150);
    EXPECT_GT(phase_ratio(smooth.command, smooth.reading).value_or(0), 0.6) << seed;
    EXPECT_FALSE(shown_stiction(smooth.command, smooth.reading)) << seed;
    EXPECT_TRUE(is_closed_loop(s.command, s.reading)) << seed;
    EXPECT_GT(phase_ratio(s.command, s.reading).value_or(0), 2.0 / 3) << seed;
    EXPECT_FALSE(shown_stiction(s.command, s.reading)) << seed;
  }
}

/// Signals of a loop, and the noise-free response of the finger to the command.
struct Following {
  Signals signals;
  std::vector<double> response;
};

/// Returns the signals of a loop whose reading follows a setpoint that changes in steps.
/// @param motion  motion of the finger for a command, before the lag. It may have a state.
/// @param step  change of the setpoint.
template <class Motion>
Following following(Motion motion, double step = 0.3) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.01);
  Following f;
  double flow = 0, sum = 0;
  for (int i = 0; i < 1500; ++i) {
    const double setpoint = step * (i / 80 % 3), error = setpoint - flow + noise(random);
    sum += 0.05 * error;
    f.signals.command.push_back(0.1 * error + sum);
    flow += 0.5 * (motion(f.signals.command.back()) - flow);
    f.response.push_back(flow);
    f.signals.reading.push_back(setpoint - error);
  }
  return f;
}

TEST(LoopPhase, StictionIsShownIfTheReadingFollowsASetpoint) {
  double stem = 0;
  const auto [s, unused] = following([&](double command) {
    if (std::abs(command - stem) > 0.3) stem = command;
    return stem;
  });
  EXPECT_TRUE(is_closed_loop(s.command, s.reading));
  EXPECT_LT(phase_ratio(s.command, s.reading).value_or(1), limits::even_phase_ratio);
  const auto found = shown_stiction(s.command, s.reading);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->band, 0.3, 0.1);
}

TEST(LoopPhase, HysteresisOfTheModelIsNoStiction) {
  double left = 0;
  const auto [s, response] = following([&](double command) {
    left = std::clamp(left, command - 0.15, command + 0.15);  // play
    return left;
  });
  EXPECT_TRUE(is_closed_loop(s.command, s.reading));
  EXPECT_TRUE(shown_stiction(s.command, s.reading));
  EXPECT_FALSE(shown_stiction(s.command, s.reading, response));
  // A response that does not describe the hysteresis gives no other explanation.
  EXPECT_TRUE(shown_stiction(s.command, s.reading, s.command));
}

TEST(LoopPhase, ACurvedCharacteristicIsNoStiction) {
  const auto exponential = [](double command) { return 0.1 * std::exp(2 * command) - 0.1; };
  const auto [s, unused] = following(exponential, 3);
  EXPECT_TRUE(is_closed_loop(s.command, s.reading));
  EXPECT_GT(best_sticking_stem(s.command, s.reading).value().log_likelihood_ratio,
            limits::strict_log_likelihood);
  EXPECT_FALSE(shown_stiction(s.command, s.reading));
}

/// With these seeds, the valve rests during the whole record. The command then only integrates the noise of
/// the readings, and nothing in the record depends on the valve.
TEST(LoopPhase, AValveThatNeverMovesShowsNoStiction) {
  for (unsigned seed = 3; seed <= 5; ++seed) {
    const Signals s = loop(0.3, 0, 0.05, 0.03, seed);
    EXPECT_GT(phase_ratio(s.command, s.reading).value_or(0), 2.0 / 3) << seed;
    EXPECT_FALSE(shown_stiction(s.command, s.reading)) << seed;
  }
}

TEST(LoopPhase, PlannedCommandIsNoClosedLoopAtAnyLag) {
  for (const double lag_share : {1.0, 0.2, 0.01}) {
    const Signals s = planned(lag_share, 3);
    EXPECT_FALSE(is_closed_loop(s.command, s.reading)) << lag_share;
    EXPECT_FALSE(shown_stiction(s.command, s.reading)) << lag_share;
  }
}

/// The command is random, and the reading follows it with a lag. The cross-correlation is therefore
/// one-sided, and its odd part is as large as for a valve with stiction. Nevertheless, the signals must not
/// count as a closed loop.
TEST(LoopPhase, RandomCommandIsNoClosedLoop) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, 1);
  Signals s;
  double reading = 0;
  for (int i = 0; i < 3000; ++i) {
    s.command.push_back(normal(random));
    reading += 0.05 * (s.command.back() - reading);
    s.reading.push_back(reading + 0.01 * normal(random));
  }
  EXPECT_FALSE(is_closed_loop(s.command, s.reading));
  EXPECT_FALSE(shown_stiction(s.command, s.reading));
}

TEST(LoopPhase, StictionIsShownDespiteGapsButNotByAConstant) {
  Signals s = loop(0.3, 0, 0.05, 0.03, 1, 0.1);
  for (std::size_t i = 0; i < s.reading.size(); i += 7)
    s.reading[i] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(shown_stiction(s.command, s.reading));
  const std::vector<double> constant(s.command.size(), 2);
  EXPECT_FALSE(phase_ratio(constant, s.reading));
  EXPECT_FALSE(shown_stiction(constant, s.reading));
  EXPECT_FALSE(shown_stiction({}, {}));
  s.command.resize(40);
  s.reading.resize(40);
  EXPECT_FALSE(is_closed_loop(s.command, s.reading));
}

}  // namespace
}  // namespace softgrip::sysid::loop_phase_test
