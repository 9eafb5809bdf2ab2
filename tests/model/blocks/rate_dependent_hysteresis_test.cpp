#include "model/blocks/rate_dependent_hysteresis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/chain.h"
#include "model/dual.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing {
namespace {

using Block = RateDependentHysteresis<double>;

// Width of the settled loop of a triangle between 0 and 40 kPa.
double width(double rate_kpa_per_s) {
  Block block = make<Block>({0.03, 10.0, 1.0, 0.0, 20.0, 0.05, 0.0});
  double from = 0;
  double up = 0, down = 0;
  for (int cycle = 0; cycle < 5; ++cycle) {
    move(block, from, 20, 20 / rate_kpa_per_s);
    up = block.output();
    move(block, from, 40, 20 / rate_kpa_per_s);
    move(block, from, 20, 20 / rate_kpa_per_s);
    down = block.output();
    move(block, from, 0, 20 / rate_kpa_per_s);
  }
  return down - up;
}

TEST(RateDependentHysteresis, LoopGrowsWithTheRateUpToItsWidth) {
  EXPECT_NEAR(width(0.01), 2 * 0.03 * 0.01, 1e-5);  // slow: viscous, gain tau rate to either side
  EXPECT_GT(width(10), 2 * width(1.0));
  // fast: dry friction. Over 40 kPa z goes from -turn to turn, half-way it has reached `middle`.
  const double turn = 10 * std::tanh(2.0);
  const double middle = 10 - (10 + turn) * std::exp(-2.0);
  EXPECT_NEAR(width(1e6), 2 * 0.03 * middle, 1e-5);
}

TEST(RateDependentHysteresis, Relaxes) {
  Block block = make<Block>({0.03, 10.0, 1.0, 0.0, 20.0, 0.05, 0.0});
  double from = 0;
  const double held = move(block, from, 30, 0.1);
  EXPECT_LT(held, -0.1);
  EXPECT_NEAR(move(block, from, 30, 2.0), held * std::exp(-2.0), 1e-12);
}

TEST(RateDependentHysteresis, StepSizeDoesNotMatter) {
  Block once = make<Block>({0.03, 10.0, 1.0, 0.0, 20.0, 0.05, 0.0}),
        often = make<Block>({0.03, 10.0, 1.0, 0.0, 20.0, 0.05, 0.0});
  double a = 0, b = 0;
  for (const double to : {40.0, 12.0, 33.0, 33.0, 5.0}) {
    const double start = b;
    for (int i = 1; i <= 20; ++i) move(often, b, start + (to - start) * i / 20, 0.05);
    EXPECT_NEAR(move(once, a, to, 1.0), often.output(), 1e-12);
  }
}

// A Bouc-Wen element whose loop grows with the rate, or whose eta does.
Model widened(double growth, double levelling = 0) {
  Model model{"widened", "test", {BlockSpec{*find_block("bouc_wen"), {0.35, 0.2, 0.03, 0.05, 1}}}};
  return with_block(
      model, {*find_block("rate_dependent_hysteresis"), {0.0, 10.0, 1.0, growth, 15.0, 0.08, levelling}});
}

struct Move {
  double to_kpa, duration_s;
};
const std::vector<Move> moves{{40, 1}, {40, 0.5}, {12, 0.2}, {33, 3}, {5, 0.1}, {5, 1}, {50, 0.01}, {0, 2}};

// The equations by Heun's method in steps of 20 microseconds.
TEST(RateDependentHysteresis, WidensTheChainsBoucWenByItsEquation) {
  Chain<double> chain(widened(0.6));
  double p = 0, h = 0, r = 0;
  for (const Move& move : moves) {
    const auto steps = static_cast<int>(std::lround(move.duration_s / 2e-5));
    const double d = (move.to_kpa - p) / steps, dt = move.duration_s / steps;
    const double way = d > 0 ? 1 : d < 0 ? -1 : 0;
    const auto slope = [&](double x) { return 0.2 - (0.03 + (x * way >= 0 ? 0.05 : -0.05)) * std::fabs(x); };
    for (int i = 0; i < steps; ++i) {
      const double k = slope(h);
      h += 0.5 * d * (k + slope(h + d * k));
      const double s = (std::fabs(d) / dt - r) / 0.08;
      r += 0.5 * dt * (s + (std::fabs(d) / dt - r - dt * s) / 0.08);
    }
    p = move.to_kpa;
    ASSERT_NEAR(chain.step(move.duration_s, p), 0.35 * p - h * (1 + 0.6 * r / (r + 15)), 1e-5) << p;
  }
}

// The same with an eta that follows the rate; the chain takes that of each step's beginning.
TEST(RateDependentHysteresis, LevelsTheChainsBoucWenOffByItsEquation) {
  for (const double levelling : {1.5, -0.6}) {
    Chain<double> chain(widened(0.0, levelling));
    double p = 0, h = 0, r = 0;
    for (const Move& move : moves) {
      const auto steps = static_cast<int>(std::lround(move.duration_s / 1e-5));
      const double d = (move.to_kpa - p) / steps, dt = move.duration_s / steps;
      const double way = d > 0 ? 1 : d < 0 ? -1 : 0;
      for (int i = 0; i < steps; ++i) {
        const double eta = 0.05 * (1 + levelling * r / (r + 15));
        const auto slope = [&](double x) {
          return 0.2 - (0.03 + (x * way >= 0 ? eta : -eta)) * std::fabs(x);
        };
        const double k = slope(h);
        h += 0.5 * d * (k + slope(h + d * k));
        r += (std::fabs(d) / dt - r) * -std::expm1(-dt / 0.08);
        chain.step(dt, p + d * (i + 1));
      }
      p = move.to_kpa;
      ASSERT_NEAR(chain.reading_mm(), 0.35 * p - h, 1e-4) << p;
    }
  }
}

TEST(RateDependentHysteresis, WidenedStepSizeDoesNotMatter) {
  Chain<double> once(widened(0.6)), often(widened(0.6));
  double from = 0;
  for (const Move& move : moves) {
    for (int i = 1; i <= 20; ++i) often.step(move.duration_s / 20, from + (move.to_kpa - from) * i / 20);
    EXPECT_NEAR(once.step(move.duration_s, move.to_kpa), often.reading_mm(), 1e-12);
    from = move.to_kpa;
  }
}

TEST(RateDependentHysteresis, SlowMotionKnowsNothingOfTheGrowth) {
  Chain<double> plain(widened(0.0)), wide(widened(0.6));
  for (const double p : {40.0, 12.0, 33.0, 0.0}) EXPECT_NEAR(wide.step(1e6, p), plain.step(1e6, p), 1e-4);
}

TEST(RateDependentHysteresis, PeekKnowsOfTheGrowth) {
  Chain<double> chain(widened(0.6, 0.8));
  for (const Move& move : moves) {
    const double h = 1e-5;
    const Dual<double> trial = chain.peek(move.duration_s, Dual<double>(move.to_kpa + 1, 1.0));
    const double up = chain.peek(move.duration_s, move.to_kpa + 1 + h);
    const double down = chain.peek(move.duration_s, move.to_kpa + 1 - h);
    ASSERT_NEAR(trial.v, (up - down) / (2 * h), 1e-6);
    const double there = chain.peek(move.duration_s, move.to_kpa);
    ASSERT_NEAR(there, chain.step(move.duration_s, move.to_kpa), 1e-12);
  }
}

}  // namespace
}  // namespace softgrip::model::testing
