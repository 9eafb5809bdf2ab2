#include "model/blocks/transport_delay.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/model/drive.h"

namespace softgrip::model::testing::transport_delay_test {
namespace {

using Block = TransportDelay<double>;

// Returns the value at time t of a piecewise linear signal whose corners are at multiples of dt.
double between(const std::vector<double>& corners, double dt, double t) {
  if (t <= 0) return corners.front();
  const auto i = static_cast<std::size_t>(t / dt);
  if (i + 1 >= corners.size()) return corners.back();
  return corners[i] + (corners[i + 1] - corners[i]) * (t / dt - static_cast<double>(i));
}

std::vector<double> random_corners(unsigned seed, std::size_t count) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> pressure(0, 60);
  std::vector<double> corners{0};
  while (corners.size() < count) corners.push_back(pressure(generator));
  return corners;
}

TEST(TransportDelay, ShiftsAnyPiecewiseLinearSignalByAnyDelay) {
  const double dt = 0.01;
  const std::vector<double> corners = random_corners(11, 400);
  for (const double delay : {1e-5, 0.0042, 0.01, 0.0133, 0.13, 0.1299, 1.7}) {
    for (const double sample_time : {0.0, dt}) {
      Block block = make<Block>({delay}, sample_time);
      for (std::size_t i = 1; i < corners.size(); ++i) {
        pass(block, Segment<double>::straight(dt, corners[i - 1], corners[i]));
        ASSERT_NEAR(block.output(), between(corners, dt, static_cast<double>(i) * dt - delay), 1e-9)
            << "delay " << delay << " sample " << i;
      }
    }
  }
}

// The size of the delay line must not overflow. The longest delay divided by the shortest sample time is not
// representable as a number of samples.
TEST(TransportDelay, AcceptsASampleTimeOfAnySize) {
  for (const double sample_time_s : {1e-300, 1e-12, 1e-6, 1e300}) {
    Block block = make<Block>({1000}, sample_time_s);
    pass(block, Segment<double>::straight(400, 0, 5));
    EXPECT_EQ(block.output(), 0);
    pass(block, Segment<double>::straight(800, 5, 5));
    EXPECT_NEAR(block.output(), 2.5, 1e-9) << sample_time_s;
  }
}

TEST(TransportDelay, OutputSegmentsAreContinuousAndPreserveTheIntegral) {
  const std::vector<double> corners = random_corners(12, 300);
  Block block = make<Block>({0.0437});
  double last = 0;
  double mean_in = 0, mean_out = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const double dt = 0.001 * static_cast<double>(1 + i % 13);
    double sum = 0;
    for (const Segment<double>& s : pass(block, Segment<double>::straight(dt, corners[i - 1], corners[i]))) {
      ASSERT_NEAR(s.begin, last, 1e-9);
      last = s.end;
      sum += s.duration_s;
      mean_out += s.mean * s.duration_s;
    }
    ASSERT_NEAR(sum, dt, 1e-12);
    mean_in += 0.5 * (corners[i - 1] + corners[i]) * dt;
  }
  // The delay line still contains the last part of the input. Apply the input 0 until the delay line is
  // empty.
  for (const Segment<double>& s : pass(block, Segment<double>::straight(0, corners.back(), 0))) {
    mean_out += s.mean * s.duration_s;
  }
  for (const Segment<double>& s : pass(block, Segment<double>::straight(1, 0, 0))) {
    mean_out += s.mean * s.duration_s;
  }
  EXPECT_NEAR(mean_out, mean_in, 1e-9);
}

TEST(TransportDelay, AKinkInsideASampleMakesTwoSegments) {
  Block block = make<Block>({0.004});
  pass(block, Segment<double>::straight(0.01, 0, 10));
  const auto out = pass(block, Segment<double>::straight(0.01, 10, 0));
  ASSERT_EQ(out.size(), 2u);
  EXPECT_NEAR(out[0].duration_s, 0.004, 1e-15);
  EXPECT_NEAR(out[0].end, 10, 1e-12);
  EXPECT_NEAR(out[1].end, 4, 1e-12);
}

TEST(TransportDelay, ADelayOfWholeSamplesGivesOneSegmentPerSample) {
  // The delay of 0.13 s is 26 steps of 0.005 s, apart from a rounding error. This rounding error must not
  // divide every following sample into a very short segment and a long one.
  for (const double delay : {0.13, 0.3, 0.07, 0.005}) {
    Block block = make<Block>({delay});
    for (int i = 0; i < 1000; ++i) {
      ASSERT_EQ(pass(block, Segment<double>::straight(0.005, i, i + 1)).size(), 1u)
          << delay << " sample " << i;
    }
  }
}

TEST(TransportDelay, AStepInputStaysAStep) {
  // The delay is exactly 3 samples, so the jump must appear at the start of the fourth sample.
  for (const double sample_time : {0.0, 0.1}) {
    Block block = make<Block>({0.3}, sample_time);
    std::vector<double> after;
    for (int i = 0; i < 6; ++i) {
      pass(block, Segment<double>::straight(0, i == 0 ? 0 : 1, 1));
      pass(block, Segment<double>::straight(0.1, 1, 1));
      after.push_back(block.output());
    }
    EXPECT_EQ(after, (std::vector<double>{0, 0, 0, 1, 1, 1}));
  }
}

TEST(TransportDelay, ZeroDelayPassesASampleAndAStepUnchanged) {
  Block block = make<Block>({0.0});
  EXPECT_EQ(pass(block, Segment<double>::straight(0, 0, 5)).size(), 1u);
  EXPECT_EQ(block.output(), 5);
  EXPECT_EQ(pass(block, Segment<double>::straight(0.1, 5, 6)).size(), 1u);
  EXPECT_EQ(block.output(), 6);
}

TEST(TransportDelay, KeepsTheMeanOfACurvedSignal) {
  Block block = make<Block>({0.035});
  const Segment<double> curved{0.1, 0, 10, 5 + 8.0 / 6};
  const auto first = pass(block, curved);
  const auto rest = pass(block, Segment<double>::straight(0.1, 10, 10));
  double mean = 0;
  for (const auto& s : first) mean += s.mean * s.duration_s;
  for (const auto& s : rest) {
    if (s.begin < 10) mean += s.mean * s.duration_s;
  }
  EXPECT_NEAR(mean, curved.mean * 0.1, 1e-12);
  EXPECT_NEAR(first.back().end, curved.at(0.65), 1e-12);
}

TEST(TransportDelay, ResetFillsTheDelayLine) {
  Block block = make<Block>({0.2});
  block.reset(7.0);
  pass(block, Segment<double>::straight(0.1, 7, 0));
  EXPECT_EQ(block.output(), 7);
}

}  // namespace
}  // namespace softgrip::model::testing::transport_delay_test
