#include "sysid/logs/excitation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace softgrip::sysid::excitation_test {
namespace {

using Missing = std::vector<Excitation>;

/// Returns a log of 40 s with the given command, sampled at 50 Hz.
template <class Command>
Log commanded(Command kpa_at) {
  Log log;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i;
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(kpa_at(t));
    log.displacement_mm.push_back(0);
  }
  return log;
}

/// Returns the command at time `t`. In each period of 10 s, the command rises to `peak_kpa` and falls, both
/// within 8 s, and then rests for 2 s.
double triangle(double t, double peak_kpa) {
  return peak_kpa * std::max(0.0, 1 - std::abs(std::fmod(t, 10) / 4 - 1));
}

TEST(MissingExcitation, LoadingOnlyLogLacksUnloading) {
  EXPECT_EQ(missing_excitation({commanded([](double t) { return 1.2 * t; })}),
            (Missing{Excitation::unloading, Excitation::rest}));
  EXPECT_EQ(missing_excitation({commanded([](double t) { return t < 5 ? 0 : 20 * std::log(1 + t - 5); })}),
            Missing{Excitation::unloading});
}

TEST(MissingExcitation, RepeatedEqualPeaksLackAmplitudes) {
  EXPECT_EQ(missing_excitation({commanded([](double t) { return triangle(t, 40); })}),
            (Missing{Excitation::rest, Excitation::amplitudes}));
  EXPECT_EQ(missing_excitation({commanded([](double t) { return t < 4 ? 0 : 20 - 20 * std::cos(t - 4); })}),
            Missing{Excitation::amplitudes});
}

/// Between two steps of this command, the pressure does not fall. The steps must therefore not be counted as
/// peaks.
TEST(MissingExcitation, StaircaseStepsAreNotCountedAsPeaks) {
  const auto stairs = [](double t) { return 8 * std::floor(std::max(0.0, 20 - std::abs(t - 20)) / 4); };
  EXPECT_EQ(missing_excitation({commanded(stairs)}), Missing{Excitation::amplitudes});
  const auto jitter = [&](double t) { return stairs(t) + 0.5 * std::sin(40 * t); };
  const std::vector<Excitation> missing = missing_excitation({commanded(jitter)});
  EXPECT_EQ(std::count(missing.begin(), missing.end(), Excitation::amplitudes), 1);
}

TEST(MissingExcitation, LogsTogetherProvideMissingExcitation) {
  const Log ramp = commanded([](double t) { return t < 4 ? 0 : t - 4; });
  const Log triangles = commanded([](double t) { return triangle(t, t < 10 ? 20 : 40); });
  EXPECT_EQ(missing_excitation({triangles}), Missing{Excitation::rest});
  EXPECT_EQ(missing_excitation({ramp, triangles}), Missing{});
}

/// A vacuum loads this finger, so the pressure falls during loading.
TEST(MissingExcitation, VacuumIsTreatedLikePressure) {
  for (const double peak_kpa : {-40.0, 40.0}) {
    EXPECT_EQ(missing_excitation({commanded([&](double t) { return peak_kpa * t / 40; })}),
              (Missing{Excitation::unloading, Excitation::rest}))
        << peak_kpa;
    EXPECT_EQ(missing_excitation(
                  {commanded([&](double t) { return triangle(t, t < 10 ? 0.5 * peak_kpa : peak_kpa); })}),
              Missing{Excitation::rest})
        << peak_kpa;
    EXPECT_TRUE(contains_rest({commanded([&](double t) { return t < 4 ? 0.0 : peak_kpa; })})) << peak_kpa;
  }
}

TEST(MissingExcitation, EachKindHasASentence) {
  EXPECT_EQ(without(Excitation::unloading),
            "the logs contain no unloading (decrease of the pressure), so hysteresis cannot be determined");
  EXPECT_EQ(without(Excitation::rest),
            "the logs contain no rest longer than 3 s at zero pressure, so creep, softening and drift are "
            "hard to separate");
  EXPECT_EQ(without(Excitation::amplitudes),
            "the logs contain only one amplitude of the pressure, so effects that depend on the amplitude "
            "cannot be determined");
}

using Indices = std::vector<std::size_t>;
using Values = std::vector<double>;

TEST(TurningPoints, AreReversalsAboveTheThreshold) {
  const Values values{0, 3, 2.6, 5, 1, 1.3, 0.5, 4};
  EXPECT_EQ(turning_points(values, 1), (Indices{0, 3, 6, 7}));
  EXPECT_EQ(turning_points(values, 0.35), (Indices{0, 1, 2, 3, 6, 7}));
  EXPECT_EQ(turning_points(values, 10), (Indices{0, 7}));
}

TEST(TurningPoints, FirstMotionMayBeDecreasing) {
  EXPECT_EQ(turning_points({5, 5.2, 1, 4}, 1), (Indices{0, 1, 2, 3}));
  EXPECT_EQ(turning_points({5, 4, 1, 4}, 1), (Indices{0, 2, 3}));
}

TEST(TurningPoints, SingleValueIsATurningPoint) {
  EXPECT_EQ(turning_points({7}, 1), Indices{0});
}

TEST(SteadyBetweenTurns, OutputIsMonotonicBetweenTurningPoints) {
  const Values values{0, 3, 2.6, 5, 1, 1.3, 0.5, 4};
  const Values steady = steady_between_turns(values, 1);
  EXPECT_EQ(steady, (Values{0, 2.8, 2.8, 5, 1.15, 1.15, 0.5, 4}));
}

TEST(SteadyBetweenTurns, NoisyHoldIsReplacedByTheMean) {
  Values values(10, 0.0);
  for (int i = 0; i < 100; ++i) values.push_back(20 + (i % 2 == 0 ? 0.1 : -0.1));
  const Values steady = steady_between_turns(values, 1);
  EXPECT_TRUE(std::is_sorted(steady.begin(), steady.end()));
  EXPECT_NEAR(steady[60], 20, 0.01);
}

TEST(SteadyBetweenTurns, MonotonicValuesStayUnchanged) {
  const Values values{4, 2, 2, 1, 3, 8, 9};
  EXPECT_EQ(steady_between_turns(values, 0.5), values);
}

}  // namespace
}  // namespace softgrip::sysid::excitation_test
