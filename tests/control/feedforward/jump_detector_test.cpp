#include "control/feedforward/jump_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace softgrip::control::jump_detector_test {
namespace {

/// Returns the number of jumps in `ticks` ticks of the reference `value_of`, a function of the tick.
template <class Value>
int jumps_of(JumpDetector& detector, int ticks, Value value_of) {
  int jumps = 0;
  for (int k = 0; k < ticks; ++k) jumps += detector.jumps_to(value_of(k)) ? 1 : 0;
  return jumps;
}

TEST(JumpDetector, CountsEachJumpOnce) {
  JumpDetector detector;
  detector.start(3);
  EXPECT_EQ(
      jumps_of(detector, 400, [](int k) { return k < 100   ? 3.0
                                                 : k < 200 ? 9.0
                                                 : k < 250 ? 8.4
                                                           : 20.0; }), 3);
}

TEST(JumpDetector, AJumpOfAnySizeDoesNotHideALaterJump) {
  for (const double size_mm : {0.6, 20.0, 1e6}) {
    JumpDetector detector;
    detector.start(0);
    EXPECT_TRUE(detector.jumps_to(size_mm));
    EXPECT_FALSE(detector.jumps_to(size_mm));
    EXPECT_TRUE(detector.jumps_to(size_mm + 0.6)) << size_mm;
  }
}

// Each jump starts a fade-out, in which the feedforward does not follow the reference.
TEST(JumpDetector, TheStartOfASineAt20HzHasAtMostTwoJumps) {
  JumpDetector detector;
  detector.start(14.4);
  EXPECT_LE(
      jumps_of(detector, 200,
               [](int k) { return 20 - 5.6 * std::cos(2 * std::numbers::pi * 0.05 * std::max(0, k - 9)); }),
      2);
}

TEST(JumpDetector, AnInterpolatedJumpCountsInBothParts) {
  JumpDetector detector;
  detector.start(6);
  EXPECT_EQ(jumps_of(detector, 100, [](int k) { return k < 50 ? 6.0 : k == 50 ? 8.0 : 10.0; }), 2);
}

// The samples of a sine differ much at low rates. The detector must become used to these differences.
TEST(JumpDetector, ASineWithFewSamplesPerPeriodHasJumpsOnlyAtItsStart) {
  struct Sine {
    double amplitude_mm, frequency_hz, tick_s;
  };
  for (const Sine& sine : {Sine{5.6, 1, 0.05}, Sine{3, 0.15, 0.5}, Sine{25, 0.25, 0.05}, Sine{25, 0.25, 0.1},
                           Sine{25, 0.25, 0.5}, Sine{25, 0.25, 1}}) {
    JumpDetector detector;
    detector.start(-sine.amplitude_mm);
    const auto value_of = [&](int k) {
      return -sine.amplitude_mm * std::cos(2 * std::numbers::pi * sine.frequency_hz * k * sine.tick_s);
    };
    (void)jumps_of(detector, 20, value_of);
    EXPECT_EQ(jumps_of(detector, 400, [&](int k) { return value_of(k + 20); }), 0)
        << sine.amplitude_mm << " " << sine.tick_s;
  }
}

TEST(JumpDetector, NoiseIsNotASequenceOfJumps) {
  for (const double noise_mm : {0.3, 3.0, 30.0}) {
    JumpDetector detector;
    detector.start(0);
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, noise_mm);
    const auto noisy = [&](int) { return normal(random); };
    EXPECT_LT(jumps_of(detector, 100, noisy), 15) << noise_mm;
    EXPECT_LT(jumps_of(detector, 10000, noisy), 5) << noise_mm;
  }
}

}  // namespace
}  // namespace softgrip::control::jump_detector_test
