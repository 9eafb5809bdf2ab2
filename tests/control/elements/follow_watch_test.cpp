#include "control/elements/follow_watch.h"

#include <gtest/gtest.h>

#include <limits>

namespace softgrip::control::follow_watch_test {
namespace {

/// Moves the model by `expected_mm` from 5 mm, and the finger by `share` times `expected_mm` from 4 mm.
/// Returns true if the watch then reports that an object holds the finger.
bool held_after(double expected_mm, double share) {
  FollowWatch watch;
  for (int i = 0; i <= 100; ++i) {
    const double way = expected_mm * i / 100;
    watch.observe(true, 4 + share * way, 5 + way);
  }
  return watch.held();
}

TEST(FollowWatch, ReportsHeldForMotionOf40PercentAndNotFor70Percent) {
  EXPECT_TRUE(held_after(5, 0));
  EXPECT_TRUE(held_after(5, 0.4)) << "the finger moves by only 40 % of the model's motion";
  EXPECT_FALSE(held_after(5, 0.7));
  EXPECT_FALSE(held_after(-3, 0.7))
      << "the finger follows the model sufficiently, also while the pressure falls";
}

TEST(FollowWatch, AssumesHeldUntilTheModelHasMovedEnough) {
  EXPECT_TRUE(held_after(0.5, 0.9));
}

TEST(FollowWatch, ReportsHeldOnlyWhileContactIsDetected) {
  FollowWatch watch;
  EXPECT_FALSE(watch.held());
  watch.observe(true, 4, 5);
  EXPECT_TRUE(watch.held());
  watch.observe(false, 4, 4.1);
  EXPECT_FALSE(watch.held());
}

TEST(FollowWatch, AnUnknownDisplacementDoesNotChangeTheState) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  FollowWatch watch;
  watch.observe(true, unknown, 5);
  EXPECT_FALSE(watch.held());
  watch.observe(true, 4, 5);
  watch.observe(true, unknown, 9);
  EXPECT_TRUE(watch.held());
}

}  // namespace
}  // namespace softgrip::control::follow_watch_test
