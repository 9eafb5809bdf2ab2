#include "model/blocks/rate_dependent_saturation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/chain.h"
#include "model/named.h"

namespace softgrip::model::testing::rate_dependent_saturation_test {
namespace {

Model saturating(double saturation) {
  const Model model{"saturating", "test", {BlockSpec{block_type<BoucWen>(), {0.35, 0.2, 0.03, 0.05, 1}}}};
  return with_block(model, {block_type<RateDependentSaturation>(), {saturation, 15.0, 0.08}});
}

struct Move {
  double to_kpa, duration_s;
};
const std::vector<Move> moves{{40, 1}, {40, 0.5}, {12, 0.2}, {33, 3}, {5, 0.1}, {5, 1}, {50, 0.01}, {0, 2}};

// Compares the chain with an integration of the equation in steps of 10 us. In each of its steps, the chain
// uses the rate at the beginning of the step.
TEST(RateDependentSaturation, FollowsTheDifferentialEquation) {
  for (const double saturation : {1.5, -0.6}) {
    Chain<double> chain(saturating(saturation));
    double p = 0, h = 0, r = 0;
    for (const Move& move : moves) {
      const auto steps = static_cast<int>(std::lround(move.duration_s / 1e-5));
      const double d = (move.to_kpa - p) / steps, dt = move.duration_s / steps;
      const double way = d > 0 ? 1 : d < 0 ? -1 : 0;
      for (int i = 0; i < steps; ++i) {
        const double eta = 0.05 * (1 + saturation * r / (r + 15));
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

TEST(RateDependentSaturation, HasNoEffectOnSlowMotion) {
  Chain<double> plain(saturating(0.0)), soon(saturating(0.8));
  for (const double p : {40.0, 12.0, 33.0, 0.0}) EXPECT_NEAR(soon.step(1e6, p), plain.step(1e6, p), 1e-4);
}

}  // namespace
}  // namespace softgrip::model::testing::rate_dependent_saturation_test
