#include "control/elements/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace softgrip::control::reference_test {
namespace {

double peak_speed(const Reference& reference, double from_s, double to_s) {
  double peak = 0;
  for (double t = from_s; t <= to_s; t += 1e-3) peak = std::max(peak, std::abs(reference.at(t).rate));
  return peak;
}

// Checks that the rate of the reference equals the central difference of the values of the reference.
void expect_consistent(const Reference& reference, double from_s, double to_s) {
  constexpr double d = 1e-5;
  for (double t = from_s; t < to_s; t += 0.0137) {
    const ReferencePoint point = reference.at(t);
    EXPECT_NEAR((reference.at(t + d).value - reference.at(t - d).value) / (2 * d), point.rate,
                1e-4 * (1 + std::abs(point.acceleration)))
        << "at " << t;
  }
}

double largest_step(const Reference& reference, double from_s, double to_s, double d) {
  double largest = 0;
  for (double t = from_s; t < to_s; t += d) {
    largest = std::max(largest, std::abs(reference.at(t + d).value - reference.at(t).value));
  }
  return largest;
}

TEST(Reference, HoldsTheStartValueWithoutSegments) {
  Reference reference;
  reference.start(5, 7.5);
  EXPECT_EQ(reference.at(0).value, 7.5);
  EXPECT_EQ(reference.at(5).value, 7.5);
  EXPECT_EQ(reference.at(1e6).value, 7.5);
  EXPECT_EQ(reference.at(6).rate, 0);
  EXPECT_EQ(reference.end_s(), 5);
}

TEST(Reference, ValueAtEqualsTheValueOfThePoint) {
  Reference reference;
  reference.start(1, 2);
  EXPECT_EQ(reference.value_at(5), reference.at(5).value);
  ASSERT_TRUE(reference.ramp_to(12, 20));
  ASSERT_TRUE(reference.hold_for(0.5));
  ASSERT_TRUE(reference.sine(14, 3, 0.5, 1.25));
  for (double t = 0; t < reference.end_s() + 1; t += 0.0137)
    EXPECT_EQ(reference.value_at(t), reference.at(t).value) << "at " << t;
}

TEST(Reference, RampKeepsItsPeakSpeedAndEndsAtRest) {
  Reference reference;
  reference.start(1, 2);
  ASSERT_TRUE(reference.ramp_to(12, 20));
  EXPECT_NEAR(reference.end_s(), 1 + 1.875 * 10 / 20, 1e-12);
  EXPECT_NEAR(peak_speed(reference, 1, reference.end_s()), 20, 1e-3);
  EXPECT_NEAR(reference.at(reference.end_s()).value, 12, 1e-12);
  EXPECT_NEAR(reference.at(reference.end_s()).rate, 0, 1e-9);
  EXPECT_NEAR(reference.at(reference.end_s()).acceleration, 0, 1e-9);
  EXPECT_EQ(reference.at(reference.end_s() + 10).value, reference.final_value());
  expect_consistent(reference, 1, 3);
}

TEST(Reference, SegmentsFollowEachOtherWithoutAStep) {
  Reference reference;
  reference.start(0, 0);
  ASSERT_TRUE(reference.ramp_to(6, 10));
  ASSERT_TRUE(reference.hold_for(0.5));
  ASSERT_TRUE(reference.sine(13, 7, 0.2, 2));
  ASSERT_TRUE(reference.ramp_for(0, 2));
  EXPECT_LT(largest_step(reference, 0, reference.end_s(), 1e-3), 0.0121);
  const double sine_start = 1.875 * 6 / 10 + 0.5;
  EXPECT_NEAR(reference.at(sine_start + 2.5).value, 20, 1e-9);
  EXPECT_NEAR(reference.at(sine_start + 1.25).rate, 7 * 2 * std::numbers::pi * 0.2, 1e-9);
}

TEST(Reference, ACutDuringAMotionIsContinuousUpToAcceleration) {
  Reference reference;
  reference.start(0, 0);
  ASSERT_TRUE(reference.ramp_to(20, 30));
  const Reference before = reference;
  const double t = 0.6;
  reference.cut(t);
  ASSERT_TRUE(reference.ramp_to(3, 15));
  EXPECT_EQ(reference.at(0.4).value, before.at(0.4).value);
  constexpr double d = 1e-6;
  EXPECT_NEAR(reference.at(t + d).value, before.at(t).value, 1e-4);
  EXPECT_NEAR(reference.at(t + d).rate, before.at(t).rate, 1e-2);
  EXPECT_NEAR(reference.at(t + d).acceleration, before.at(t).acceleration, 1);
  EXPECT_LE(peak_speed(reference, t, reference.end_s()), 30 * 1.001);
  EXPECT_NEAR(reference.final_value(), 3, 1e-9);
}

TEST(Reference, ACutAfterTheEndHoldsTheFinalValueUntilTheCut) {
  Reference reference;
  reference.start(0, 1);
  ASSERT_TRUE(reference.ramp_for(2, 1));
  reference.cut(5);
  ASSERT_TRUE(reference.ramp_for(4, 1));
  EXPECT_NEAR(reference.at(4.999).value, 2, 1e-9);
  EXPECT_NEAR(reference.at(6).value, 4, 1e-9);

  Reference at_rest;
  at_rest.start(0, 1);
  at_rest.cut(5);
  ASSERT_TRUE(at_rest.ramp_for(4, 1));
  EXPECT_NEAR(at_rest.at(5).value, 1, 1e-9);
}

TEST(Reference, ForgettingFreesSegmentsAndKeepsLaterValues) {
  Reference reference;
  reference.start(0, 0);
  for (std::size_t i = 0; i < Reference::capacity; ++i) {
    ASSERT_TRUE(reference.ramp_for(static_cast<double>(i + 1), 1));
  }
  EXPECT_FALSE(reference.ramp_for(100, 1));
  EXPECT_EQ(reference.final_value(), 8);
  const double later = reference.at(6.3).value;
  reference.forget_before(5.5);
  EXPECT_EQ(reference.at(6.3).value, later);
  EXPECT_TRUE(reference.ramp_for(0, 1));
  EXPECT_NEAR(reference.at(9).value, 0, 1e-12);
}

TEST(Reference, RefusesInvalidSpeedsDurationsAndFrequencies) {
  Reference reference;
  EXPECT_FALSE(reference.ramp_to(1, 0));
  EXPECT_FALSE(reference.ramp_for(1, 0));
  EXPECT_FALSE(reference.ramp_for(1, std::nan("")));
  EXPECT_FALSE(reference.hold_for(-1));
  EXPECT_FALSE(reference.sine(1, 1, 0, 1));
  EXPECT_EQ(reference.at(3).value, 0);
}

TEST(Reference, ARefusedSegmentChangesNothingAtFullCapacity) {
  Reference reference;
  reference.start(0, 0);
  for (std::size_t i = 1; i <= Reference::capacity; ++i) {
    ASSERT_TRUE(reference.ramp_for(static_cast<double>(i), 1));
  }
  const double end_s = reference.end_s();
  EXPECT_FALSE(reference.ramp_to(0, 1));
  EXPECT_FALSE(reference.ramp_for(0, 1));
  EXPECT_FALSE(reference.hold_for(1));
  EXPECT_FALSE(reference.sine(1, 1, 1, 1));
  EXPECT_EQ(reference.end_s(), end_s);
  EXPECT_EQ(reference.final_value(), static_cast<double>(Reference::capacity));
}

TEST(Reference, ARampToTheCurrentValueTakesNoTime) {
  Reference reference;
  reference.start(2, 5);
  EXPECT_TRUE(reference.ramp_to(5, 10));
  EXPECT_EQ(reference.end_s(), 2);
  EXPECT_EQ(reference.at(3).value, 5);
  EXPECT_FALSE(reference.sine(1, 1, 1, 0)) << "a sine needs at least one cycle";
}

TEST(Reference, ARampFromAMovingStartReachesTheTarget) {
  Reference reference;
  reference.start(0, {5, 20, 0});
  ASSERT_TRUE(reference.ramp_to(5, 10));
  EXPECT_GT(reference.end_s(), 0);
  EXPECT_NEAR(reference.at(reference.end_s()).value, 5, 1e-12);
  expect_consistent(reference, 1e-3, reference.end_s());
  reference.start(0, {5, 0, 30});
  ASSERT_TRUE(reference.ramp_to(6, 10));
  EXPECT_NEAR(reference.at(reference.end_s()).value, 6, 1e-12);
  EXPECT_NEAR(reference.at(reference.end_s()).rate, 0, 1e-9);
}

// The reference must remain continuous while segments are removed and appended at random.
TEST(Reference, StaysContinuousUnderRandomCutsAndRamps) {
  const unsigned seed = 20250117;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(0, 25), speed(5, 40), ahead(0, 0.5);
  Reference reference;
  reference.start(0, 3);
  double last = 3;
  for (int i = 0; i < 20000; ++i) {
    const double t = i * 1e-3;
    if (random() % 100 == 0) reference.forget_before(t - 0.1);
    if (random() % 200 == 0) {
      reference.cut(t + ahead(random));
      (void)reference.ramp_to(value(random), speed(random));
    }
    const double now = reference.at(t).value;
    ASSERT_LE(std::abs(now - last), 0.05) << "at " << t;
    last = now;
  }
}

TEST(Reference, RefusesSegmentsThatAreNotFinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), most = 1e308;
  Reference reference;
  reference.start(0, most);
  EXPECT_FALSE(reference.ramp_for(-most, 1)) << "the distance overflows";
  EXPECT_FALSE(reference.ramp_to(-most, 1)) << "the distance overflows";
  EXPECT_FALSE(reference.ramp_for(nan, 1));
  EXPECT_FALSE(reference.sine(most, most, 1, 1)) << "the sum of mean and amplitude overflows";
  EXPECT_FALSE(reference.sine(1, 1, most, most)) << "the angular frequency overflows";
  EXPECT_FALSE(reference.sine(1, 1, 1e-300, most)) << "the duration overflows";
  EXPECT_FALSE(reference.hold_for(std::numeric_limits<double>::infinity()));
  reference.start(0, 0);
  EXPECT_FALSE(reference.ramp_for(5, 1e-120)) << "the coefficients overflow";
  EXPECT_EQ(reference.at(1).value, 0);
  EXPECT_EQ(reference.end_s(), 0);
  EXPECT_TRUE(reference.ramp_for(5, 1e-20));
  EXPECT_NEAR(reference.at(1).value, 5, 1e-9);
}

TEST(Reference, ARefusedRampAfterACutChangesNothing) {
  Reference reference;
  ASSERT_TRUE(reference.ramp_for(10, 2));
  reference.cut(1);
  const double end_s = reference.end_s();
  EXPECT_FALSE(reference.ramp_to(std::numeric_limits<double>::infinity(), 10));
  EXPECT_EQ(reference.end_s(), end_s) << "the ramp that brakes the reference is removed too";
}

}  // namespace
}  // namespace softgrip::control::reference_test
