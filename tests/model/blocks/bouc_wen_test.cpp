#include "model/blocks/bouc_wen.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::bouc_wen_test {
namespace {

using Block = BoucWen<double>;

// Parameters alpha, beta, gamma, eta and exponent. eta exceeds |gamma|, so a closed hysteresis loop never
// produces energy.
const std::vector<std::vector<double>> materials{{0.211, 0.171, 0.016, 0.024, 1},
                                                 {0.35, 0.2, -0.02, 0.05, 1},
                                                 {0.211, 0.171, 0.004, 0.006, 2},
                                                 {0.3, 0.2, 0.0005, 0.001, 3},
                                                 {0.3, 0.2, 0.0002, 0.0003, 4}};

Block make_material(const std::vector<double>& values) {
  return Block(values, Preparation{});
}

std::vector<double> random_turning_points(unsigned seed, int count) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> pressure(-20, 60);
  std::vector<double> points;
  for (int i = 0; i < count; ++i) points.push_back(pressure(generator));
  return points;
}

TEST(BoucWen, OutputIsRateIndependent) {
  for (const auto& values : materials) {
    Block slow = make_material(values);
    Block fast = make_material(values);
    double a = 0, b = 0;
    for (const double p : random_turning_points(3, 200))
      ASSERT_EQ(move(slow, a, p, 10.0), move(fast, b, p, 1e-6));
  }
}

TEST(BoucWen, StepSizeDoesNotMatter) {
  for (const auto& values : materials) {
    const double tolerance = values[4] == 1 ? 1e-12 : 1e-7;
    Block once = make_material(values);
    Block often = make_material(values);
    double a = 0, b = 0;
    for (const double p : random_turning_points(4, 100)) {
      const double start = b;
      for (int i = 1; i <= 37; ++i) move(often, b, start + (p - start) * i / 37, 1e-3);
      ASSERT_NEAR(move(once, a, p, 1e-3), often.output(), tolerance) << "exponent " << values[4];
    }
  }
}

TEST(BoucWen, SolvesItsEquation) {
  // Compares finite differences of the hysteretic state h with the differential equation for dh/dp. Omits
  // points near a sign change of h.
  for (const auto& v : materials) {
    Block block = make_material(v);
    double from = 0;
    for (const double p : random_turning_points(5, 100)) {
      move(block, from, p, 1);
      const double s = p > 20 ? -1 : 1;
      Block ahead = block;
      double at = from;
      const double d = 1e-3;
      const double h0 = block.hysteresis_mm();
      move(ahead, at, from + s * d, 1);
      const double h1 = ahead.hysteresis_mm();
      const double h = 0.5 * (h0 + h1);
      if (h0 * h1 <= 0) continue;
      const double size = std::pow(std::fabs(h), v[4] - 1);
      const double rate = v[1] - v[2] * size * std::fabs(h) - v[3] * s * size * h;
      ASSERT_NEAR((h1 - h0) / (s * d), rate, 1e-7);
      ASSERT_NEAR(block.slope(s > 0), rate, 1e-3);
    }
  }
}

TEST(BoucWen, StateStaysBounded) {
  for (const auto& v : materials) {
    const double bound = std::pow(v[1] / (v[2] + v[3]), 1 / v[4]);
    Block block = make_material(v);
    double from = 0;
    for (int i = 0; i < 2000; ++i) {
      move(block, from, i % 2 == 0 ? 500 : -500, 1);
      ASSERT_LE(std::fabs(block.hysteresis_mm()), bound * (1 + 1e-9));
    }
  }
}

TEST(BoucWen, ClosedLoopsDissipate) {
  // The pressure never does negative work over a settled hysteresis loop. The work is positive if eta is
  // positive.
  for (const auto& v : materials) {
    Block block = make_material(v);
    double from = 0;
    for (int cycle = 0; cycle < 30; ++cycle) {
      move(block, from, 50, 1);
      move(block, from, 5, 1);
    }
    double area = 0;
    for (const double to : {50.0, 5.0}) {
      const double start = from;
      for (int i = 1; i <= 2000; ++i) {
        const double y = block.output();
        const double p = from;
        move(block, from, start + (to - start) * i / 2000, 1);
        area += 0.5 * (p + from) * (block.output() - y);
      }
    }
    EXPECT_GT(area, 0.01) << "exponent " << v[4];
  }
}

TEST(BoucWen, HasNoHysteresisLoopWithoutEta) {
  Block block = make<Block>({0.21, 0.17, 0.02, 0.0, 1});
  double from = 0;
  const double up = move(block, from, 20, 1);
  move(block, from, 60, 1);
  EXPECT_NEAR(move(block, from, 20, 1), up, 1e-12);
}

TEST(BoucWen, FirstLoadingDependsOnlyOnTheSumOfGammaAndEta) {
  Block a = make<Block>({0.21, 0.17, 0.01, 0.03, 1});
  Block b = make<Block>({0.21, 0.17, 0.03, 0.01, 1});
  double pa = 0, pb = 0;
  for (int p = 1; p <= 60; ++p) ASSERT_NEAR(move(a, pa, p, 1), move(b, pb, p, 1), 1e-13);
  EXPECT_GT(std::fabs(move(a, pa, 0, 1) - move(b, pb, 0, 1)), 0.1);
}

TEST(BoucWen, MeanOfASegmentIsTheIntegral) {
  for (const auto& v : materials) {
    Block block = make_material(v);
    double from = 0;
    move(block, from, 30, 1);
    for (const double to : {30.4, 29.9, 29.3, 28.9}) {
      Block fine = block;
      double at = from, integral = 0;
      for (int i = 1; i <= 4000; ++i) {
        const double y = fine.output();
        move(fine, at, from + (to - from) * i / 4000, 1);
        integral += 0.5 * (y + fine.output()) / 4000;
      }
      const Segment<double> out = block.step(Segment<double>::straight(1, from, to), {});
      EXPECT_NEAR(out.mean, integral, 1e-7);
      from = to;
    }
  }
}

TEST(BoucWen, ResetPlacesTheStateOnTheFirstLoadingCurve) {
  for (const auto& v : materials) {
    Block held = make_material(v);
    held.reset(25.0);
    Block risen = make_material(v);
    double from = 0;
    EXPECT_NEAR(held.output(), move(risen, from, 25, 1), 1e-12);
  }
}

TEST(BoucWen, EqualGammaAndEtaAreNoSpecialCase) {
  Block equal = make<Block>({0.21, 0.17, 0.02, 0.02, 1});
  Block near = make<Block>({0.21, 0.17, 0.02, 0.02 + 1e-13, 1});
  double a = 0, b = 0;
  for (const double p : random_turning_points(6, 200))
    ASSERT_NEAR(move(equal, a, p, 1), move(near, b, p, 1), 1e-9);
}

TEST(BoucWen, RefusesAStateThatGrowsWithoutBound) {
  EXPECT_FALSE(Block::objection(std::vector<double>{0.2, 0.2, -0.03, 0.02, 1}).empty());
  EXPECT_TRUE(Block::objection(std::vector<double>{0.2, 0.2, -0.02, 0.02, 1}).empty());
}

}  // namespace
}  // namespace softgrip::model::testing::bouc_wen_test
