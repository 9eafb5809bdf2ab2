#include "model/blocks/rate_dependent_width.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/chain.h"
#include "model/dual.h"
#include "model/named.h"

namespace softgrip::model::testing::rate_dependent_width_test {
namespace {

// Returns a Bouc-Wen element whose loop becomes wider with the input rate. If `saturation` is not 0, the
// saturation of the element depends on the rate as well.
Model widened(double growth, double saturation = 0) {
  Model model{"widened", "test", {BlockSpec{block_type<BoucWen>(), {0.35, 0.2, 0.03, 0.05, 1}}}};
  model = with_block(model, {block_type<RateDependentWidth>(), {growth, 15.0, 0.08}});
  if (saturation == 0) return model;
  return with_block(model, {block_type<RateDependentSaturation>(), {saturation, 15.0, 0.08}});
}

struct Move {
  double to_kpa, duration_s;
};
const std::vector<Move> moves{{40, 1}, {40, 0.5}, {12, 0.2}, {33, 3}, {5, 0.1}, {5, 1}, {50, 0.01}, {0, 2}};

// Compares the chain with an integration of the equations by Heun's method in steps of 20 us.
TEST(RateDependentWidth, FollowsTheDifferentialEquation) {
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

TEST(RateDependentWidth, OutputIsIndependentOfTheStepSize) {
  Chain<double> once(widened(0.6)), often(widened(0.6));
  double from = 0;
  for (const Move& move : moves) {
    for (int i = 1; i <= 20; ++i) often.step(move.duration_s / 20, from + (move.to_kpa - from) * i / 20);
    EXPECT_NEAR(once.step(move.duration_s, move.to_kpa), often.reading_mm(), 1e-12);
    from = move.to_kpa;
  }
}

TEST(RateDependentWidth, HasNoEffectOnSlowMotion) {
  Chain<double> plain(widened(0.0)), wide(widened(0.6));
  for (const double p : {40.0, 12.0, 33.0, 0.0}) EXPECT_NEAR(wide.step(1e6, p), plain.step(1e6, p), 1e-4);
}

TEST(RateDependentWidth, PeekIncludesTheRateDependence) {
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
}  // namespace softgrip::model::testing::rate_dependent_width_test
