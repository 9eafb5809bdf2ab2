#include "sysid/fitting/descent.h"

#include <limits>
#include <stop_token>

#include <gtest/gtest.h>

// GCC 12 incorrectly warns that a new std::stop_source is not initialised.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace softgrip::sysid::descent_test {
namespace {

/// Rosenbrock's function, written as the two residuals 10 (y - x^2) and 1 - x. The variables have bounds. The
/// minimum is 0 at (1, 1).
struct Rosenbrock {
  Eigen::Vector2d lower = Eigen::Vector2d::Constant(-1e9);
  Eigen::Vector2d upper = Eigen::Vector2d::Constant(1e9);
  int losses = 0;

  static Eigen::Vector2d residuals(const Eigen::Vector2d& at) {
    return {10 * (at(1) - at(0) * at(0)), 1 - at(0)};
  }
  double loss(const Eigen::Vector2d& at) {
    ++losses;
    return residuals(at).squaredNorm();
  }
  static NormalEquations normal(const Eigen::Vector2d& at) {
    Eigen::Matrix2d jacobian;
    jacobian << -20 * at(0), 10, -1, 0;
    return {jacobian.transpose() * residuals(at), jacobian.transpose() * jacobian};
  }
  [[nodiscard]] StepBounds bounds(const Eigen::Vector2d& at) const { return {lower - at, upper - at}; }
  static Eigen::Vector2d moved(const Eigen::Vector2d& from, const Eigen::VectorXd& step) {
    return from + step;
  }
};

TEST(Descent, FindsTheMinimumOfRosenbrocksValley) {
  Rosenbrock problem;
  const auto end = descend(problem, Eigen::Vector2d(-1.2, 1), {.most_steps = 200, .least_gain = 1e-20});
  EXPECT_TRUE(end.converged);
  EXPECT_NEAR(end.point(0), 1, 1e-8);
  EXPECT_NEAR(end.point(1), 1, 1e-8);
}

/// Where the Gauss-Newton model is exact, the damping decreases to a third. If a step gains half of the
/// predicted gain, the damping stays. Failures in a row increase it faster and faster.
TEST(Descent, TheDampingFollowsTheGainRatio) {
  const DescentOptions options{.damping = 0.9, .rule = DampingRule::gain_ratio};
  const NormalEquations normal{Eigen::Vector2d(-1, 0), Eigen::Matrix2d::Identity()};
  const Eigen::Vector2d step(1, 0);  // predicted gain of the loss: 2 - 1
  Damping exact(options);
  exact.succeed(normal, step, 1);
  EXPECT_DOUBLE_EQ(exact.now(), 0.3);
  Damping half(options);
  half.succeed(normal, step, 0.5);
  EXPECT_DOUBLE_EQ(half.now(), 0.9);
  half.fail();
  half.fail();
  EXPECT_DOUBLE_EQ(half.now(), 0.9 * 2 * 4);
  half.succeed(normal, step, 0.5);
  half.fail();
  EXPECT_DOUBLE_EQ(half.now(), 0.9 * 2 * 4 * 2);
}

TEST(Descent, StaysWithinBoundsAndMovesAlongThem) {
  // With the bound y <= 0.25, the minimum is at the x for which 400 x^3 - 98 x - 2 = 0. This x is close to
  // 0.5.
  Rosenbrock problem;
  problem.upper(1) = 0.25;
  const auto end = descend(problem, Eigen::Vector2d(-0.3, 0.25), {.most_steps = 200, .least_gain = 1e-16});
  EXPECT_TRUE(end.converged);
  EXPECT_EQ(end.point(1), 0.25);
  const double x = end.point(0);
  EXPECT_NEAR(400 * x * x * x - 98 * x - 2, 0, 1e-3);
}

TEST(Descent, CoordinateAtABoundDoesNotReduceOtherSteps) {
  const NormalEquations normal{Eigen::Vector2d(1, 1), (Eigen::Matrix2d() << 2, 1.9, 1.9, 2).finished()};
  const StepBounds bounds{Eigen::Vector2d(0, -10), Eigen::Vector2d(10, 10)};
  const Eigen::VectorXd step = damped_step(normal, bounds, 0, {});
  EXPECT_EQ(step(0), 0);
  EXPECT_NEAR(step(1), -0.5, 1e-9);
}

TEST(Descent, NoStepIsLongerThanAllowed) {
  const NormalEquations normal{Eigen::Vector2d(100, -100), Eigen::Matrix2d::Identity()};
  const double infinity = std::numeric_limits<double>::infinity();
  const StepBounds bounds{Eigen::Vector2d::Constant(-infinity), Eigen::Vector2d::Constant(infinity)};
  const Eigen::VectorXd step = damped_step(normal, bounds, 0, {.longest_step = 0.5});
  EXPECT_EQ(step(0), -0.5);
  EXPECT_EQ(step(1), 0.5);
}

TEST(Descent, ACoordinateWithoutCurvatureIsDampedByTheOthers) {
  const NormalEquations normal{Eigen::Vector2d(-1, -1), Eigen::Vector2d(100, 0).asDiagonal()};
  const StepBounds bounds{Eigen::Vector2d::Constant(-1e9), Eigen::Vector2d::Constant(1e9)};
  const DescentOptions options{.longest_step = 1e9, .least_damping = 0.01};
  const Eigen::VectorXd step = damped_step(normal, bounds, 0.1, options);
  EXPECT_NEAR(step(1), 1 / (0.1 * 0.01 * 100), 1e-3);
}

TEST(Descent, LeavesAStartWithInfiniteLoss) {
  struct Impossible : Rosenbrock {
    static double loss(const Eigen::Vector2d& at) {
      return at(0) < -1 ? std::numeric_limits<double>::infinity() : residuals(at).squaredNorm();
    }
  } problem;
  const auto end = descend(problem, Eigen::Vector2d(-1.2, 1), {.most_steps = 200, .least_share = 1e-9});
  EXPECT_NEAR(end.point(0), 1, 1e-3);
}

TEST(Descent, CountsStepsAndTrials) {
  Rosenbrock problem;
  const auto end = descend(problem, Eigen::Vector2d(-1.2, 1), {.most_steps = 3});
  EXPECT_EQ(end.steps, 3);
  EXPECT_FALSE(end.converged);
  // The start point is the minimum, so no trial step reduces the loss. The loss must be computed once for the
  // start point and once for each of the 5 trial steps.
  Rosenbrock again;
  const auto none = descend(again, Eigen::Vector2d(1, 1), {.most_trials = 5});
  EXPECT_EQ(none.steps, 0);
  EXPECT_TRUE(none.converged);
  EXPECT_EQ(again.losses, 6);
}

TEST(Descent, WithoutCoordinatesTheStartIsReturned) {
  struct Constant {
    static double loss(double value) { return value; }
    static NormalEquations normal(double /*value*/) { return {}; }
    static StepBounds bounds(double /*value*/) { return {}; }
    static double moved(double value, const Eigen::VectorXd& /*step*/) { return value; }
  } problem;
  const auto end = descend(problem, 7.0, {});
  EXPECT_TRUE(end.converged);
  EXPECT_EQ(end.point, 7.0);
}

TEST(Descent, EndsIfTheComputationIsCancelled) {
  std::stop_source stop;
  const ThreadBudget budget(1, stop.get_token());
  stop.request_stop();
  Rosenbrock problem;
  EXPECT_THROW((void)descend(problem, Eigen::Vector2d(-1.2, 1), {}), WorkCancelled);
}

}  // namespace
}  // namespace softgrip::sysid::descent_test
