#include "model/blocks/asymmetric_bouc_wen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "model/chain.h"
#include "model/dual.h"

namespace softgrip::model::testing::asymmetric_bouc_wen_test {
namespace {

// Parameters of the element: alpha, beta, gamma, eta and exponent.
const std::vector<std::vector<double>> materials{
    {0.35, 0.2, 0.03, 0.05, 1}, {0.35, 0.2, -0.02, 0.05, 1}, {0.211, 0.171, 0.004, 0.006, 2}};

Model skewed(const std::vector<double>& material, double delta_per_kpa, double epsilon_per_kpa = 0,
             double beta_share = 0) {
  Model model{"skewed", "test", {BlockSpec{block_type<BoucWen>(), material}}};
  return with_block(model, {block_type<AsymmetricBoucWen>(), {delta_per_kpa, epsilon_per_kpa, beta_share}});
}

const std::vector<double> turns{40, 12, 33, -15, 8, -3, 60, 0, 25, 0};

// Integrates the published equation with the Runge-Kutta method and 200 steps per kPa.
double integrated(const std::vector<double>& v, const BoucWenSkew<double>& skew,
                  const std::vector<double>& turning_points,
                  const std::function<void(double p, double y)>& at) {
  const auto sign = [](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; };
  const auto slope = [&](double h, double way) {
    const double eta = v[3] + skew.epsilon_per_kpa * sign(way);
    return v[1] * (1 + skew.beta_share * sign(way)) -
           std::pow(std::fabs(h), v[4]) * (v[2] + eta * sign(way * h) + skew.delta_per_kpa * sign(way));
  };
  double p = 0, h = 0;
  for (const double to : turning_points) {
    const int steps = static_cast<int>(std::ceil(std::fabs(to - p) * 200));
    const double d = (to - p) / steps;
    for (int i = 0; i < steps; ++i) {
      const double k1 = slope(h, d), k2 = slope(h + 0.5 * d * k1, d), k3 = slope(h + 0.5 * d * k2, d),
                   k4 = slope(h + d * k3, d);
      h += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      p += d;
    }
    p = to;
    at(p, v[0] * p - h);
  }
  return v[0] * p - h;
}

TEST(AsymmetricBoucWen, DeltaFollowsTheDifferentialEquation) {
  for (const std::vector<double>& material : materials) {
    for (const double share : {-0.8, 0.6}) {
      const double delta = share * std::min(material[3], material[2] + material[3]);
      Chain<double> chain(skewed(material, delta));
      integrated(material, {delta, 0, 0}, turns, [&](double p, double y) {
        // The equation has a kink at h = 0. At this kink, the integration error of the test reaches 2e-5.
        ASSERT_NEAR(chain.step(1.0, p), y, 2e-5) << "exponent " << material[4] << " at " << p;
      });
    }
  }
}

TEST(AsymmetricBoucWen, AllSkewParametersFollowTheDifferentialEquation) {
  for (const std::vector<double>& material : materials) {
    for (const double way : {-1.0, 1.0}) {
      const BoucWenSkew<double> skew{0.2 * way * material[3], -0.3 * way * material[3], 0.15 * way};
      Chain<double> chain(skewed(material, skew.delta_per_kpa, skew.epsilon_per_kpa, skew.beta_share));
      integrated(material, skew, turns, [&](double p, double y) {
        ASSERT_NEAR(chain.step(1.0, p), y, 2e-5) << "exponent " << material[4] << " at " << p;
      });
    }
  }
}

// If a saturated hysteretic state increased after a reversal of the pressure, its magnitude would grow with
// every cycle.
TEST(AsymmetricBoucWen, StateStaysBoundedForEveryValidSkew) {
  for (const std::vector<double>& material : materials) {
    for (const double epsilon : {-5.0, 5.0}) {
      for (const double share : {-0.9, 0.9}) {
        Chain<double> chain(skewed(material, 0.0, epsilon, share));
        double highest = 0;
        for (int i = 0; i < 40; ++i)
          highest = std::fmax(highest, std::fabs(chain.step(1.0, i % 2 == 0 ? 60 : 0)));
        EXPECT_LT(highest, 100) << epsilon << " " << share;
      }
    }
  }
}

// In the limit, the saturated state is an equilibrium. It must not be an unstable one, because rounding
// errors would grow exponentially.
TEST(AsymmetricBoucWen, StateStaysBoundedForRandomReversals) {
  constexpr unsigned seed = 5;
  for (const double epsilon : {-10.0, -3.0, -1.0, 1.0, 10.0}) {
    for (const double share : {-0.9, -0.3, -0.05, 0.05, 0.3, 0.9}) {
      std::mt19937_64 random(seed);
      std::uniform_real_distribution<double> pressure_kpa(0, 100);
      Chain<double> chain(skewed({0.35, 0.2, 0.03, 0.03, 1}, 0.01, epsilon, share));
      double highest = 0;
      for (int i = 0; i < 2000; ++i)
        highest = std::fmax(highest, std::fabs(chain.step(0.1, pressure_kpa(random))));
      EXPECT_LT(highest, 100) << epsilon << " " << share << ", seed " << seed;
    }
  }
}

TEST(AsymmetricBoucWen, OutputIsIndependentOfTheStepSize) {
  for (const std::vector<double>& material : materials) {
    const Model model = skewed(material, 0.5 * material[3], -0.2 * material[3], 0.1);
    Chain<double> once(model), often(model);
    double from = 0;
    for (const double to : turns) {
      for (int i = 1; i <= 40; ++i) often.step(1.0 / 40, from + (to - from) * i / 40);
      ASSERT_NEAR(once.step(1.0, to), often.reading_mm(), material[4] == 1 ? 1e-12 : 1e-7);
      from = to;
    }
  }
}

TEST(AsymmetricBoucWen, ZeroSkewEqualsTheSymmetricModel) {
  for (const std::vector<double>& material : materials) {
    Chain<double> plain(Model{"plain", "test", {BlockSpec{block_type<BoucWen>(), material}}});
    Chain<double> with(skewed(material, 0.0));
    for (const double p : turns) ASSERT_EQ(with.step(1.0, p), plain.step(1.0, p));
  }
}

// The inverse of the model uses peek(), so peek() must include the effect of the skew parameters.
TEST(AsymmetricBoucWen, PeekIncludesTheSkewParameters) {
  for (const std::vector<double>& material : materials) {
    Chain<double> chain(skewed(material, -0.7 * material[3], 0.2 * material[3], -0.1));
    for (const double p : turns) {
      const double h = 1e-5;
      const Dual<double> trial = chain.peek(1.0, Dual<double>(p, 1.0));
      const double up = chain.peek(1.0, p + h), down = chain.peek(1.0, p - h);
      ASSERT_NEAR(trial.v, (up - down) / (2 * h), 1e-6);
      ASSERT_NEAR(trial.a, chain.step(1.0, p), 1e-12);
    }
  }
}

// During the first loading, the parameter delta has the same effect as an increase of gamma + eta. During
// unloading, the two effects differ.
TEST(AsymmetricBoucWen, DeltaActsLikeGammaPlusEtaDuringFirstLoading) {
  const std::vector<double> other{0.35, 0.2, 0.02, 0.04, 1};
  Chain<double> a(skewed({0.35, 0.2, 0.03, 0.05, 1}, -0.02));
  Chain<double> b(Model{"plain", "test", {BlockSpec{block_type<BoucWen>(), other}}});
  for (int p = 1; p <= 60; ++p) ASSERT_NEAR(a.step(1.0, p), b.step(1.0, p), 1e-12);
  EXPECT_GT(std::fabs(a.step(1.0, 20) - b.step(1.0, 20)), 0.05);
}

TEST(AsymmetricBoucWen, DeltaIsLimitedToTheValueOfEta) {
  Chain<double> most(skewed({0.35, 0.2, 0.03, 0.05, 1}, 0.05));
  Chain<double> more(skewed({0.35, 0.2, 0.03, 0.05, 1}, 5.0));
  for (const double p : turns) ASSERT_EQ(most.step(1.0, p), more.step(1.0, p));
}

}  // namespace
}  // namespace softgrip::model::testing::asymmetric_bouc_wen_test
