#pragma once
// Descends to a minimum within bounds by damped Gauss-Newton steps (Levenberg 1944, Marquardt 1963). All fits
// use this descent. A fit to residuals with known derivatives calls it through minimise().

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include "base/thread_budget.h"

namespace softgrip::sysid {

/// Gradient and approximate curvature of half the loss, with respect to the coordinates of a search.
struct NormalEquations {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd curvature;  ///< Gauss-Newton approximation of the second derivatives
};

/// Largest permitted change of each coordinate in both directions, with lower <= 0 <= upper.
struct StepBounds {
  Eigen::VectorXd lower, upper;
};

/// Rule for the damping of the next trial.
enum class DampingRule : std::uint8_t {
  /// A success divides the damping by 6, a failure multiplies it by 6. For fits that eliminate their linear
  /// parameters: their curvature is an approximation, so their predicted gain is inaccurate.
  fixed_factor,
  /// The damping follows the ratio of the gain to the predicted gain (Nielsen, Damping parameter in
  /// Marquardt's method, Technical University of Denmark, IMM-REP-1999-05).
  gain_ratio
};

struct DescentOptions {
  int most_steps = 40;  ///< maximum number of steps that reduce the loss
  /// Maximum number of trials per step; each trial has more damping than the trial before.
  int most_trials = 8;
  /// Maximum number of trials of all steps together.
  int most_evaluations = std::numeric_limits<int>::max();
  double damping = 1e-2;  ///< damping of the first trial, as a share of the curvature
  DampingRule rule = DampingRule::fixed_factor;
  double longest_step = 1;  ///< largest change of a coordinate in one step
  /// The descent ends if no trial reduces the loss, or after a step that reduces the loss by less than
  /// least_share times the loss plus least_gain.
  double least_share = 0;
  double least_gain = 0;  ///< constant part of the limit below which a decrease of the loss ends the descent
  /// Factor of the smallest damping of a coordinate. This damping is the factor times the current damping
  /// times the sum of all curvatures.
  double least_damping = 0;
};

/// Result of a descent to a minimum.
template <class Point>
struct Descent {
  Point point;
  int steps = 0;
  bool converged = false;  ///< false: the descent ended because a maximum of steps or trials was reached
};

/// Returns one damped Gauss-Newton step. A coordinate at a bound stays at the bound if the loss would
/// decrease beyond this bound.
[[nodiscard]] Eigen::VectorXd damped_step(const NormalEquations& normal, const StepBounds& bounds,
                                          double damping, const DescentOptions& options);

/// Damping of the trials of a descent.
class Damping {
 public:
  explicit Damping(const DescentOptions& options) : rule_(options.rule), now_(options.damping) {}

  [[nodiscard]] double now() const { return now_; }
  /// Increases the damping after a trial that did not reduce the loss.
  void fail();
  /// Changes the damping after a step that reduced the loss by `gain`.
  void succeed(const NormalEquations& normal, const Eigen::VectorXd& step, double gain);

 private:
  DampingRule rule_;
  double now_;
  double more_ = 2;
};

/// Descends from a start point to a minimum of the loss. `Problem` has the functions
///   double loss(const Point&)                         infinity or NaN if the point is impossible
///   NormalEquations normal(const Point&)
///   StepBounds bounds(const Point&)
///   Point moved(const Point&, const Eigen::VectorXd& step)
/// Throws WorkCancelled if the computation is cancelled.
template <class Problem, class Point>
[[nodiscard]] Descent<Point> descend(Problem& problem, Point start, const DescentOptions& options) {
  Descent<Point> descent{std::move(start)};
  Damping damping(options);
  double loss = problem.loss(descent.point);
  StepBounds bounds = problem.bounds(descent.point);
  descent.converged = bounds.lower.size() == 0;
  int evaluations = 0;
  const auto may_go_on = [&] { return evaluations < options.most_evaluations; };
  while (descent.steps < options.most_steps && may_go_on() && !descent.converged) {
    const NormalEquations normal = problem.normal(descent.point);
    double gain = 0;
    int trial = 0;
    for (; trial < options.most_trials && may_go_on() && gain == 0; ++trial, ++evaluations) {
      end_if_cancelled();
      const Eigen::VectorXd step = damped_step(normal, bounds, damping.now(), options);
      Point moved = problem.moved(descent.point, step);
      const double moved_loss = problem.loss(moved);
      if (!(moved_loss < loss)) {
        damping.fail();
        continue;
      }
      gain = loss - moved_loss;
      loss = moved_loss;
      descent.point = std::move(moved);
      bounds = problem.bounds(descent.point);
      ++descent.steps;
      damping.succeed(normal, step, gain);
    }
    const double least = options.least_share * (loss + gain) + options.least_gain;
    descent.converged = gain == 0 ? trial == options.most_trials : std::isfinite(gain) && gain < least;
  }
  return descent;
}

}  // namespace softgrip::sysid
