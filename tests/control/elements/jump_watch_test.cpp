#include "control/elements/jump_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/time.h"

namespace softgrip::control::jump_watch_test {
namespace {

constexpr double tick_s = 0.01;

/// Passes the readings of a finger to the watch. The model predicts the displacement `model`, and the reading
/// is `model` + `off`.
class Watched {
 public:
  using Value = std::function<double(double)>;
  /// Returns true if the watch reported an unsteady reading during the run.
  bool run(
      double seconds, const Value& off, const Value& model = [](double) { return 5.0; }) {
    bool ever = false;
    for (const double end_s = time_s_ + seconds; time_s_ < end_s; time_s_ += tick_s) {
      watch.observe(nanoseconds(time_s_), model(time_s_) + off(time_s_), model(time_s_));
      ever = ever || watch.unsteady();
    }
    return ever;
  }
  JumpWatch watch{PlausibilitySettings{}};

 private:
  double time_s_ = 1;
};

/// Returns a square wave that alternates between 0 mm and 5 mm every `interval_s`.
double square(double time_s, double interval_s) {
  return std::fmod(time_s, 2 * interval_s) < interval_s ? 0 : 5;
}

TEST(JumpWatch, TenJumpsPerSecondAreUnsteadyUntilTheCalmTimeEnds) {
  Watched finger;
  EXPECT_TRUE(finger.run(1, [](double t) { return square(t, 0.1); }));
  EXPECT_NEAR(std::abs(finger.watch.last_jump_mm()), 5, 1e-9);
  finger.run(JumpWatch::calm_s - 0.5, [](double) { return 0; });
  EXPECT_TRUE(finger.watch.unsteady());
  finger.run(1, [](double) { return 0; });
  EXPECT_FALSE(finger.watch.unsteady());
  EXPECT_FALSE(finger.run(5, [](double) { return 0; }));
}

TEST(JumpWatch, DetectsJumpsWhileTheFingerMoves) {
  Watched finger;
  EXPECT_TRUE(finger.run(
      2, [](double t) { return square(t, 0.1); }, [](double t) { return 10 + 8 * std::sin(3 * t); }));
}

TEST(JumpWatch, RepeatedJumpsInOneDirectionAreNotUnsteady) {
  Watched finger;
  EXPECT_FALSE(finger.run(3, [](double t) { return 3 * std::floor(t / 0.2); }));
}

TEST(JumpWatch, SlowJumpsBackAndForthAreNotUnsteady) {
  Watched finger;
  EXPECT_FALSE(finger.run(6, [](double t) { return square(t, 0.6); }));
}

TEST(JumpWatch, NoiseAndPredictedFastMotionAreNotUnsteady) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.3);
  Watched finger;
  EXPECT_FALSE(finger.run(
      20, [&](double) { return noise(random); }, [](double t) { return 15 + 15 * std::sin(12 * t); }))
      << "successive readings differ by up to 1.8 mm, but the model predicts this motion";
}

TEST(JumpWatch, AConstantReadingDoesNotJumpWhileTheModelMoves) {
  JumpWatch watch{PlausibilitySettings{}};
  for (double t = 1; t < 5; t += tick_s) watch.observe(nanoseconds(t), 4, 10 + 20 * std::sin(20 * t));
  EXPECT_FALSE(watch.unsteady());
}

TEST(JumpWatch, AJumpAcrossAGapInTheReadingsDoesNotCount) {
  JumpWatch watch{PlausibilitySettings{}};
  for (int i = 0; i < 40; ++i) watch.observe(nanoseconds(1 + 0.1 * i), i % 2 == 0 ? 0 : 5, 0);
  EXPECT_FALSE(watch.unsteady()) << "a jump from a reading older than max_age_s does not count";
}

TEST(JumpWatch, JumpSizeAndCountThresholdsComeFromTheSettings) {
  PlausibilitySettings settings;
  settings.jump_mm = 6;
  JumpWatch coarse(settings);
  settings.jump_mm = 2;
  settings.unsteady_jumps = 12;
  JumpWatch patient(settings);
  for (double t = 1; t < 5; t += tick_s) {
    coarse.observe(nanoseconds(t), square(t, 0.1), 0);
    patient.observe(nanoseconds(t), square(t, 0.1), 0);
  }
  EXPECT_FALSE(coarse.unsteady());
  EXPECT_FALSE(patient.unsteady()) << "10 jumps per second are fewer than the 12 that the settings require";
}

TEST(JumpWatch, ResetClearsTheUnsteadyStateAndTheLastJump) {
  Watched finger;
  finger.run(1, [](double t) { return square(t, 0.1); });
  finger.watch.reset();
  EXPECT_FALSE(finger.watch.unsteady());
  EXPECT_EQ(finger.watch.last_jump_mm(), 0);
}

}  // namespace
}  // namespace softgrip::control::jump_watch_test
