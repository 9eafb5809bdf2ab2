#include "sysid/logs/input_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace softgrip::sysid::input_smoothing_test {
namespace {

struct Signal {
  std::vector<double> time_s, truth, measured;
};

/// Returns triangles with holds at irregular sample times, like those of the pressure of a regulator.
Signal triangles(double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> interval(0.005, 0.015);
  Signal s;
  for (double t = 0; t < 40; t += interval(random)) {
    const double phase = std::fmod(t, 10.0);
    s.time_s.push_back(t);
    s.truth.push_back(phase < 4 ? 10 * phase : phase < 6 ? 40 : 10 * (10 - phase));
    s.measured.push_back(s.truth.back() + noise * normal(random));
  }
  return s;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(InputSmoothing, FindsTheNoiseOfASignal) {
  for (const double noise : {0.05, 0.3, 1.0}) {
    const Signal s = triangles(noise, 3);
    EXPECT_NEAR(white_noise_of(s.time_s, s.measured), noise, 0.06 * noise);
  }
}

TEST(InputSmoothing, FindsTheNoiseOfASensorThatIsSlowerThanTheLog) {
  const Signal s = triangles(0.3, 3);
  std::vector<double> sparse = s.measured, time_s, values;
  for (std::size_t i = 0; i < sparse.size(); ++i) {
    if (i % 2 == 1) {
      sparse[i] = std::nan("");
      continue;
    }
    time_s.push_back(s.time_s[i]);
    values.push_back(sparse[i]);
  }
  EXPECT_EQ(white_noise_of(s.time_s, sparse), white_noise_of(time_s, values));
  EXPECT_NEAR(white_noise_of(s.time_s, sparse), 0.3, 0.03);
}

TEST(InputSmoothing, RemovesMostNoiseAndKeepsCorners) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Signal s = triangles(0.3, seed);
    const std::vector<double> smooth = smoothed(s.time_s, s.measured, white_noise_of(s.time_s, s.measured));
    EXPECT_LT(rms(smooth, s.truth), 0.1) << "seed " << seed;
    for (std::size_t i = 0; i < smooth.size(); ++i) EXPECT_NEAR(smooth[i], s.truth[i], 0.6) << s.time_s[i];
  }
}

/// Returns holds of some seconds with jumps between them. The slope before a jump is 0, so it does not
/// predict the jump.
Signal jumps(double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signal s;
  constexpr double levels[] = {0, 40, 15, 55, 0, 30, 0};
  for (int i = 0; i < 2800; ++i) {
    s.time_s.push_back(0.01 * i);
    s.truth.push_back(levels[i / 400]);
    s.measured.push_back(s.truth.back() + noise * normal(random));
  }
  return s;
}

double total_variation(const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t i = 1; i < values.size(); ++i) sum += std::abs(values[i] - values[i - 1]);
  return sum;
}

TEST(InputSmoothing, StepSignalIsSmoothBetweenSteps) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Signal s = jumps(0.05, seed);
    EXPECT_LT(rms(smoothed(s.time_s, s.measured, 0.05), s.truth), 0.02) << "seed " << seed;
  }
}

TEST(InputSmoothing, SmoothedSignalHasTheTrueTotalVariation) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Signal jumping = jumps(0.05, seed), slow = triangles(0.3, seed);
    for (Signal* const s : {&jumping, &slow}) {
      EXPECT_GT(smooth_input(s->time_s, s->measured), 0);
      const double truth = total_variation(s->truth);
      EXPECT_NEAR(total_variation(s->measured), truth, 0.01 * truth) << "seed " << seed;
    }
  }
}

TEST(InputSmoothing, HasNoDelay) {
  const Signal s = triangles(0.3, 5);
  const std::vector<double> smooth = smoothed(s.time_s, s.measured, 0.3);
  double up = 0, down = 0;
  int ups = 0, downs = 0;
  for (std::size_t i = 0; i < s.truth.size(); ++i) {
    const double phase = std::fmod(s.time_s[i], 10.0);
    if (phase > 1 && phase < 3) up += smooth[i] - s.truth[i], ++ups;
    if (phase > 7 && phase < 9) down += smooth[i] - s.truth[i], ++downs;
  }
  EXPECT_NEAR(up / ups - down / downs, 0, 0.02)
      << "at 10 kPa/s a delay of 1 ms would separate the branches by 0.02 kPa";
}

TEST(InputSmoothing, ResultIsIndependentOfTheUnit) {
  Signal s = triangles(0.3, 6);
  const std::vector<double> one = smoothed(s.time_s, s.measured, 0.3);
  for (double& v : s.measured) v *= 1000;
  const std::vector<double> other = smoothed(s.time_s, s.measured, 300);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(other[i], 1000 * one[i], 1e-3);
}

TEST(InputSmoothing, InterpolatesMissingSamples) {
  Signal s = triangles(0.1, 7);
  for (std::size_t i = 100; i < 130; ++i) s.measured[i] = std::nan("");
  s.measured.front() = std::nan("");
  const std::vector<double> smooth = smoothed(s.time_s, s.measured, 0.1);
  for (std::size_t i = 100; i < 130; ++i) EXPECT_NEAR(smooth[i], s.truth[i], 0.3);
}

TEST(InputSmoothing, LeavesANoiseFreeColumnUnchanged) {
  Signal s = triangles(0, 8);
  EXPECT_EQ(smooth_input(s.time_s, s.measured), 0);
  EXPECT_EQ(s.measured, s.truth);
  std::vector<double> constant(s.time_s.size(), 500.0);
  EXPECT_EQ(smooth_input(s.time_s, constant), 0);
}

}  // namespace
}  // namespace softgrip::sysid::input_smoothing_test
