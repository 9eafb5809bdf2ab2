#include "model/blocks/pressure_regulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/regulated_pressure.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::pressure_regulator_test {
namespace {

using Block = PressureRegulator<double>;

/// Computes the reference solution: integrates the equations in steps of 2 us without exponential functions.
/// Its code for the flow of ISO 6358 is independent of the code of the block.
class SmallSteps {
 public:
  SmallSteps(double filling_s, double venting_s, double overlap, double integral_s, double full)
      : filling_s_(filling_s),
        venting_s_(venting_s),
        overlap_(overlap),
        integral_s_(integral_s),
        full_(full) {}

  void go(double lasts, double from, double to) {
    const int count = static_cast<int>(lasts / 2e-6);
    const double h = lasts / count;
    for (int k = 0; k < count; ++k) {
      const double error = from + (to - from) * (k + 0.5) / count - pressure_;
      const double asked = error + integral_;
      if (!(full_ > 0 && std::abs(asked) > full_ && asked * error > 0)) integral_ += h * error / integral_s_;
      const double v = full_ > 0 ? std::clamp(asked, -full_, full_) : asked;
      if (v > overlap_) pressure_ += h * (v - overlap_) / filling_s_;
      if (v < -overlap_) pressure_ += h * (v + overlap_) / venting_s_ * outflow(pressure_) / outflow(50);
    }
  }
  double pressure_ = 0;

 private:
  static double outflow(double gauge) {
    if (gauge <= 0) return 0;
    const double from = gauge + 101.325, ratio = 101.325 / from, b = 0.3;
    const auto psi = [b](double r) { return std::sqrt(1 - std::pow((r - b) / (1 - b), 2)); };
    return from * (ratio < 0.995 ? psi(ratio) : psi(0.995) * (1 - ratio) / 0.005);
  }

  double filling_s_, venting_s_, overlap_, integral_s_, full_;
  double integral_ = 0;
};

/// Returns the largest difference between the block and the reference solution [kPa]. Some inputs are
/// constant over a step, like the output of a board. Other inputs are ramps. All times are multiplied by
/// `slower`.
double largest_difference_kpa(double slower) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> pressure(0, 60), duration(0.1, 0.4);
  Block block = make<Block>({0.03 * slower, 0.05 * slower, 0.6, 0.4 * slower, 11});
  SmallSteps referee(0.03, 0.05, 0.6, 0.4, 11);
  double at = 0, worst = 0;
  for (int i = 0; i < 80; ++i) {
    const double to = pressure(random), lasts = duration(random), from = i % 2 == 0 ? at : to;
    referee.go(lasts, from, to);
    if (from != at) pass(block, Segment<double>::straight(0, at, from));
    pass(block, Segment<double>::straight(lasts * slower, from, to));
    worst = std::max(worst, std::abs(block.output() - referee.pressure_));
    at = to;
  }
  return worst;
}

TEST(PressureRegulator, AgreesWithASmallStepIntegrator) {
  // The largest error is 0.2 % of the largest jump. This error occurs when the integral starts to change
  // within a step. The ramps have up to 600 kPa/s.
  EXPECT_LT(largest_difference_kpa(1), 0.002 * 62) << "seed 31";
}

TEST(PressureRegulator, IsAsAccurateForASlowRegulator) {
  for (const double slower : {5.0, 100.0, 1e5})
    EXPECT_LT(largest_difference_kpa(slower), 0.002 * 62) << slower << " times slower, seed 31";
}

TEST(PressureRegulator, IsConstantUntilTheIntegralExceedsTheOverlap) {
  Block block = make<Block>({0.02, 0.02, 0.5, 0.4, 0});
  block.reset(20);
  pass(block, Segment<double>::straight(0, 20, 20.4));
  pass(block, Segment<double>::straight(0.05, 20.4, 20.4));
  EXPECT_EQ(block.output(), 20);
  // The control error plus the integral of the control error is 0.4 kPa (1 + t / 0.4 s). After 0.1 s, this
  // sum reaches the overlap of 0.5 kPa, so the valve opens.
  pass(block, Segment<double>::straight(0.04, 20.4, 20.4));
  EXPECT_EQ(block.output(), 20);
  pass(block, Segment<double>::straight(0.5, 20.4, 20.4));
  EXPECT_GT(block.output(), 20.2);
}

TEST(PressureRegulator, SettlesAtTheCommandedPressure) {
  Block block = make<Block>({0.02, 0.03, 0.5, 0.4, 12});
  pass(block, Segment<double>::straight(0, 0, 30));
  for (int i = 0; i < 400; ++i) pass(block, Segment<double>::straight(0.02, 30, 30));
  EXPECT_NEAR(block.output(), 30, 0.05);
}

TEST(PressureRegulator, FlowSaturatesAtFullOpening) {
  Block block = make<Block>({0.05, 0.05, 0, 0, 10});
  pass(block, Segment<double>::straight(0, 0, 60));
  pass(block, Segment<double>::straight(0.1, 60, 60));
  EXPECT_NEAR(block.output(), 0.1 * 10 / 0.05, 1e-9);
}

TEST(PressureRegulator, FlowSaturatesDuringASteepRamp) {
  // A step of the command in a log is a ramp of one sampling interval.
  for (const double lasts : {0.002, 0.005, 0.01}) {
    for (const auto& [from, to] : {std::pair{0.0, 60.0}, {5.0, 60.0}, {60.0, 0.0}, {60.0, 20.0}}) {
      Block block = make<Block>({0.03, 0.05, 0.5, 0.4, 12});
      SmallSteps referee(0.03, 0.05, 0.5, 0.4, 12);
      block.reset(from);
      referee.pressure_ = from;
      for (const auto& [begin, end, seconds] : {std::tuple{from, to, lasts}, {to, to, 0.1}}) {
        pass(block, Segment<double>::straight(seconds, begin, end));
        referee.go(seconds, begin, end);
        EXPECT_NEAR(block.output(), referee.pressure_, 0.002 * 60)
            << "ramp of " << lasts << " s from " << from << " to " << to << " kPa, after " << seconds << " s";
      }
    }
  }
}

TEST(PressureRegulator, EqualsTheValveLagDuringFilling) {
  Block regulator = make<Block>({0.06, 0.1, 0, 0, 0});
  auto lag = make<AsymmetricValveLag<double>>({0.06, 0.1});
  for (const auto& [from, to] : {std::pair{0.0, 10.0}, {10.0, 35.0}, {35.0, 60.0}}) {
    pass(regulator, Segment<double>::straight(0.03, from, to));
    pass(lag, Segment<double>::straight(0.03, from, to));
    EXPECT_NEAR(regulator.output(), lag.output(), 1e-9);
  }
}

TEST(PressureRegulator, ALongRestIsOneSegment) {
  Block block = make<Block>({0.02, 0.03, 0.5, 0.4, 12});
  block.reset(20);
  const auto out = pass(block, Segment<double>::straight(1e9, 20, 20));
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out.front().duration_s, 1e9);
  EXPECT_EQ(out.front().mean, 20);
}

TEST(PressureRegulator, RefusesAFullOpeningWithinTheOverlap) {
  EXPECT_FALSE(Block::objection(std::array{0.02, 0.03, 0.5, 0.4, 0.5}).empty());
  EXPECT_TRUE(Block::objection(std::array{0.02, 0.03, 0.5, 0.4, 0.6}).empty());
  EXPECT_TRUE(Block::objection(std::array{0.02, 0.03, 0.5, 0.4, 0.0}).empty());
}

/// Returns the number of steps for a jump of the command from 0 to 40 kPa and a segment of this duration.
int steps_after_a_jump(const RegulatorNumbers<double>& numbers, double segment_s) {
  RegulatedPressure<double> regulator(numbers);
  regulator.step(Segment<double>::straight(segment_s, 40, 40), [](const Segment<double>&) {});
  return regulator.steps();
}

TEST(RegulatedPressure, ALongSegmentNeedsFewSteps) {
  const RegulatorNumbers<double> usual{0.03, 0.05, 0.4, 0.4, 12}, fast{0.05, 0.05, 0.6, 40, 11},
      slow{3, 5, 0.4, 40, 12};
  EXPECT_EQ(steps_after_a_jump(usual, 0.001), 1);
  EXPECT_EQ(steps_after_a_jump(usual, 0.02), 4);
  EXPECT_LE(steps_after_a_jump(fast, 20), 60);
  EXPECT_LE(steps_after_a_jump(slow, 20), 80);
  // The limit of the integral, 40 s / 20, makes at least 500 steps necessary.
  EXPECT_LE(steps_after_a_jump(slow, 1000), 560);
}

/// Compares steps of 20 s with steps of 1 ms: the pressures at the ends, and the area below the pressure.
TEST(RegulatedPressure, LongerStepsAreAsAccurate) {
  const RegulatorNumbers<double> numbers{0.05, 0.05, 0.6, 40, 11};
  RegulatedPressure<double> whole(numbers), fine(numbers);
  double area = 0, fine_area = 0;
  const auto add_to = [](double& sum) {
    return [&sum](const Segment<double>& s) { sum += s.mean * s.duration_s; };
  };
  double from = 0;
  for (const double to : {40.0, 5.0, 6.0, 60.0}) {
    for (const double begin : {from, to}) {  // a ramp, and then a rest at its end
      whole.step(Segment<double>::straight(20, begin, to), add_to(area));
      for (int i = 0; i < 20000; ++i) {
        const double share = i / 2e4, end_share = (i + 1) / 2e4;
        fine.step(
            Segment<double>::straight(0.001, begin + (to - begin) * share, begin + (to - begin) * end_share),
            add_to(fine_area));
      }
      EXPECT_NEAR(whole.output(), fine.output(), 0.01) << begin << " to " << to;
    }
    from = to;
  }
  for (const double kpa : {40.0, 5.0}) {
    whole.step(Segment<double>::straight(20, kpa, kpa), add_to(area));
    for (int i = 0; i < 20000; ++i) fine.step(Segment<double>::straight(0.001, kpa, kpa), add_to(fine_area));
    EXPECT_NEAR(whole.output(), fine.output(), 0.01) << kpa;
  }
  EXPECT_NEAR(area, fine_area, 2e-3 * fine_area);
}

TEST(RegulatedPressure, MeanEqualsTheAverageOverSmallSteps) {
  RegulatedPressure<double> whole({0.03, 0.05, 0.4, 0.4, 12}), fine({0.03, 0.05, 0.4, 0.4, 12});
  double area = 0, fine_area = 0;
  whole.step(Segment<double>::straight(0.08, 0, 40),
             [&](const Segment<double>& s) { area += s.mean * s.duration_s; });
  for (int i = 0; i < 160; ++i) {
    fine.step(Segment<double>::straight(0.0005, 0.25 * i, 0.25 * (i + 1)),
              [&](const Segment<double>& s) { fine_area += s.mean * s.duration_s; });
  }
  EXPECT_NEAR(area, fine_area, 2e-3 * fine_area);
}

}  // namespace
}  // namespace softgrip::model::testing::pressure_regulator_test
