#include "model/blocks/linear_modes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "model/blocks/inertia.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::linear_modes_test {
namespace {

using Block = LinearModes<double>;

// The expected values come from a numerical integration by SciPy (solve_ivp, DOP853, relative tolerance
// 1e-12). The block has an oscillating mode, a mode with two real poles, and a negative static gain.
TEST(LinearModes, RampAndHoldResponseMatchesANumericalIntegration) {
  Block block = make<Block>({0.15, 0.2, 0.1, 0.5, -0.3, 0.6, 3.0, -0.8, 0.4});
  constexpr std::array<std::pair<double, double>, 6> expected{{{0.1, 1.035965286},
                                                               {0.3, 3.432942482},
                                                               {0.5, 4.874347220},
                                                               {0.6, 4.399380275},
                                                               {1.0, 1.170388204},
                                                               {2.0, -1.317240251}}};
  double time_s = 0, pressure_kpa = 0;
  for (const auto& [until_s, displacement_mm] : expected) {
    const double next_kpa = std::fmin(24 * until_s, 12);
    EXPECT_NEAR(move(block, pressure_kpa, next_kpa, until_s - time_s), displacement_mm, 1e-8) << until_s;
    time_s = until_s;
  }
}

TEST(LinearModes, AModeWithUnitGainEqualsTheInertiaBlock) {
  Block block = make<Block>({0, 0.13, 0.3, 1, 0});
  auto inertia = make<Inertia<double>>({0.13, 0.3});
  const Segment<double> in{0.05, 0, 4, 2 + 1.2 / 6};
  const Segment<double> out = block.step(in, {});
  const auto expected = pass(inertia, in);
  EXPECT_NEAR(out.end, expected[0].end, 1e-12);
  EXPECT_NEAR(out.mean, expected[0].mean, 1e-12);
}

TEST(LinearModes, MeanEqualsTheAverageOverShortSegments) {
  for (const double damping_ratio : {0.1, 1.0, 40.0}) {
    Block once = make<Block>({0.2, 0.3, damping_ratio, 0.4, -0.7}), often = once;
    const Segment<double> out = once.step(Segment<double>::straight(0.4, 0, 10), {});
    double mean = 0;
    for (int i = 0; i < 1000; ++i)
      mean += often.step(Segment<double>::straight(0.0004, 0.01 * i, 0.01 * (i + 1)), {}).mean / 1000;
    EXPECT_NEAR(out.end, often.output(), 1e-9) << damping_ratio;
    EXPECT_NEAR(out.mean, mean, 1e-9) << damping_ratio;
  }
}

/// First-order lag in long double. It is computed with the functions phi_k(x) = sum of x^j / (j + k)!, where
/// x is the negative ratio of the duration to the time constant. They have no cancellation for small x.
struct Lag {
  long double time_constant_s;
  long double value = 0, mean = 0;

  static long double phi(int k, long double x) {
    long double term = 1, sum = 0;
    for (int i = 2; i <= k; ++i) term /= i;
    for (int j = 1; j < 40; ++j) {
      sum += term;
      term *= x / (j + k);
    }
    return sum;
  }
  /// Advances by a segment. Its input is the parabola y0 + y1 s + y2 s^2, with s in [0, 1].
  void advance(const Segment<double>& in) {
    const long double h = in.duration_s / time_constant_s;
    const long double y2 = -static_cast<long double>(in.bend());
    const long double y1 = static_cast<long double>(in.end) - in.begin - y2;
    const auto sum = [&](int k) {
      return value * phi(k, -h) +
             h * (in.begin * phi(k + 1, -h) + y1 * phi(k + 2, -h) + 2 * y2 * phi(k + 3, -h));
    };
    mean = sum(1);
    value = sum(0);
  }
};

// In partial fractions, a mode with two real poles is the difference of two lags. The segments are much
// shorter than the slow time constant, and the closed form of the solution would lose all digits in the first
// cases.
TEST(LinearModes, AStronglyDampedModeEqualsTheDifferenceOfTwoLags) {
  for (const auto& [period_s, damping, tolerance] :
       {std::tuple(100.0, 100.0, 1e-11), {100.0, 1.5, 1e-11}, {3.0, 100.0, 1e-11}, {1.2, 100.0, 1e-4}}) {
    const long double omega = 2 * std::numbers::pi_v<long double> / period_s;
    const long double root = std::sqrt(static_cast<long double>(damping) * damping - 1);
    Lag slow{(damping + root) / omega}, fast{1 / (omega * (damping + root))};
    const auto mode = [&](long double of_slow, long double of_fast) {
      return (slow.time_constant_s * of_slow - fast.time_constant_s * of_fast) /
             (slow.time_constant_s - fast.time_constant_s);
    };
    Block block = make<Block>({0.1, period_s, damping, 0.3, 0});
    const auto pressure_kpa = [](double tick) { return -60 * std::expm1(-tick * 0.01); };
    double end_error = 0, mean_error = 0;
    for (int i = 0; i < 20000; ++i) {
      const double begin = pressure_kpa(i), end = pressure_kpa(i + 1);
      const Segment<double> in{0.001, begin, end, (begin + 4 * pressure_kpa(i + 0.5) + end) / 6};
      const Segment<double> out = block.step(in, {});
      slow.advance(in);
      fast.advance(in);
      const auto expected_end = static_cast<double>(0.1L * end + 0.3L * mode(slow.value, fast.value));
      const auto expected_mean = static_cast<double>(0.1L * in.mean + 0.3L * mode(slow.mean, fast.mean));
      end_error = std::fmax(end_error, std::abs(out.end - expected_end));
      mean_error = std::fmax(mean_error, std::abs(out.mean - expected_mean));
    }
    EXPECT_LT(end_error, tolerance) << period_s << " s, damping ratio " << damping;
    EXPECT_LT(mean_error, tolerance) << period_s << " s, damping ratio " << damping;
  }
}

// The block uses a series for short segments and the closed form for long segments. Both must give the same
// response.
TEST(LinearModes, ShortSegmentsGiveTheResponseOfLongSegments) {
  for (const double damping : {0.05, 0.999, 1.0, 1.001, 7.0}) {
    Block once = make<Block>({0.2, 0.3, damping, 0.4, -0.7}), often = once;
    once.step(Segment<double>::straight(0.1, 0, 10), {});
    for (int i = 0; i < 10000; ++i)
      often.step(Segment<double>::straight(1e-5, 0.001 * i, 0.001 * (i + 1)), {});
    EXPECT_NEAR(once.output(), often.output(), 1e-10) << damping;
  }
}

// The formulas for two complex poles, a double pole and two real poles meet at the damping ratio 1.
TEST(LinearModes, TheResponseIsContinuousAtTheDampingRatioOne) {
  const auto response = [](double damping_ratio) {
    Block block = make<Block>({0, 0.3, damping_ratio, 1, 0.5});
    block.step(Segment<double>::straight(0, 0, 10), {});
    block.step(Segment<double>::straight(0.07, 10, 10), {});
    return block.output();
  };
  for (const double distance : {1e-9, 4e-7, 6e-7, 1e-5}) {
    EXPECT_NEAR(response(1 - distance), response(1), 20 * distance) << distance;
    EXPECT_NEAR(response(1 + distance), response(1), 20 * distance) << distance;
    EXPECT_NEAR(response(1 - distance) + response(1 + distance), 2 * response(1), 1e-8) << distance;
  }
}

TEST(LinearModes, APressureStepChangesOnlyTheDirectFeedthrough) {
  Block block = make<Block>({0.2, 0.3, 0.5, 1, 2});
  const Segment<double> out = block.step(Segment<double>::straight(0, 0, 10), {});
  EXPECT_EQ(out.begin, 0);
  EXPECT_NEAR(out.end, 2, 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::linear_modes_test
