#include "control/feedforward/jump_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace softgrip::control::jump_detector_test {
namespace {

constexpr double tick_s = 0.005;
constexpr double span_mm = 25;

/// Returns the number of jumps in `ticks` ticks of the reference `value_of`, a function of the tick.
template <class Value>
int jumps_of(JumpDetector& detector, int ticks, Value value_of) {
  int jumps = 0;
  for (int k = 0; k < ticks; ++k) jumps += detector.jumps_to(value_of(k)) ? 1 : 0;
  return jumps;
}

TEST(JumpDetector, CountsEachJumpOnce) {
  JumpDetector detector(tick_s, span_mm);
  detector.start(3);
  EXPECT_EQ(
      jumps_of(detector, 400, [](int k) { return k < 100   ? 3.0
                                                 : k < 200 ? 9.0
                                                 : k < 250 ? 8.4
                                                           : 20.0; }), 3);
}

TEST(JumpDetector, AJumpOfAnySizeDoesNotHideALaterJump) {
  for (const double size_mm : {0.6, 20.0, 1e6}) {
    JumpDetector detector(tick_s, span_mm);
    detector.start(0);
    EXPECT_TRUE(detector.jumps_to(size_mm));
    EXPECT_FALSE(detector.jumps_to(size_mm));
    EXPECT_TRUE(detector.jumps_to(size_mm + 0.6)) << size_mm;
  }
}

TEST(JumpDetector, TheThresholdIsAChangeOfSpeedForLongTicks) {
  for (const double long_tick_s : {0.005, 0.05, 0.1, 0.5}) {
    SCOPED_TRACE(long_tick_s);
    JumpDetector detector(long_tick_s, span_mm);
    detector.start(0);
    EXPECT_FALSE(detector.jumps_to(99 * long_tick_s));
    detector.start(0);
    EXPECT_TRUE(detector.jumps_to(101 * long_tick_s));
  }
}

TEST(JumpDetector, TheThresholdIsAShareOfALargeSpan) {
  JumpDetector detector(tick_s, 300);
  detector.start(0);
  EXPECT_FALSE(detector.jumps_to(2.9));
  detector.start(0);
  EXPECT_TRUE(detector.jumps_to(3.1));
}

TEST(JumpDetector, ASineWithFewSamplesPerPeriodHasNoJumps) {
  for (const double long_tick_s : {0.05, 0.1, 0.5, 1.0}) {
    JumpDetector detector(long_tick_s, 300);
    detector.start(75);
    EXPECT_EQ(
        jumps_of(detector, 400,
                 [&](int k) { return 100 - 25 * std::cos(2 * std::numbers::pi * 0.25 * k * long_tick_s); }),
        0)
        << long_tick_s;
  }
}

TEST(JumpDetector, NoiseIsNotASequenceOfJumps) {
  for (const double noise_mm : {0.3, 3.0, 30.0}) {
    JumpDetector detector(tick_s, span_mm);
    detector.start(0);
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, noise_mm);
    const auto noisy = [&](int) { return normal(random); };
    EXPECT_LT(jumps_of(detector, 100, noisy), 15) << noise_mm;
    EXPECT_LT(jumps_of(detector, 10000, noisy), 5) << noise_mm;
  }
}

TEST(JumpDetector, AValueThatIsNotFiniteIsIgnored) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(value);
    JumpDetector detector(tick_s, span_mm);
    detector.start(1);
    EXPECT_FALSE(detector.jumps_to(value));
    EXPECT_FALSE(detector.jumps_to(1.1));
    EXPECT_TRUE(detector.jumps_to(2));
  }
}

}  // namespace
}  // namespace softgrip::control::jump_detector_test
