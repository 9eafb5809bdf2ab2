#pragma once
// Descends to a minimum within bounds by damped Gauss-Newton steps (Levenberg 1944, Marquardt 1963). Fits
// that eliminate their linear parameters use this descent. Fits that search over all parameters use
// minimise() instead.

#include <algorithm>
#include <cmath>
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

struct DescentOptions {
  int most_steps = 40;  ///< maximum number of steps that reduce the loss
  /// Maximum number of trials per step; each trial has more damping than the trial before.
  int most_trials = 8;
  double damping = 1e-2;    ///< damping of the first trial, as a share of the curvature
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
  bool converged = false;  ///< false: the descent ended because the maximum number of steps was reached
};

/// Returns one damped Gauss-Newton step. A coordinate at a bound stays at the bound if the loss would
/// decrease beyond this bound.
[[nodiscard]] Eigen::VectorXd damped_step(const NormalEquations& normal, const StepBounds& bounds,
                                          double damping, const DescentOptions& options);

/// Descends from a start point to a minimum of the loss. `Problem` has the functions
///   double loss(const Point&)                         infinity or NaN if the point is impossible
///   NormalEquations normal(const Point&)
///   StepBounds bounds(const Point&)
///   Point moved(const Point&, const Eigen::VectorXd& step)
/// Throws WorkCancelled if the computation is cancelled.
template <class Problem, class Point>
[[nodiscard]] Descent<Point> descend(Problem& problem, Point start, const DescentOptions& options) {
  constexpr double more_damping = 6, less_damping = 1 / more_damping, weakest_damping = 1e-10;
  Descent<Point> descent{std::move(start)};
  double damping = options.damping;
  double loss = problem.loss(descent.point);
  StepBounds bounds = problem.bounds(descent.point);
  descent.converged = bounds.lower.size() == 0;
  while (descent.steps < options.most_steps && !descent.converged) {
    const NormalEquations normal = problem.normal(descent.point);
    double gain = 0;
    for (int trial = 0; trial < options.most_trials && gain == 0; ++trial) {
      end_if_cancelled();
      Point moved = problem.moved(descent.point, damped_step(normal, bounds, damping, options));
      const double moved_loss = problem.loss(moved);
      if (!(moved_loss < loss)) {
        damping *= more_damping;
        continue;
      }
      gain = loss - moved_loss;
      loss = moved_loss;
      descent.point = std::move(moved);
      bounds = problem.bounds(descent.point);
      ++descent.steps;
      damping = std::max(damping * less_damping, weakest_damping);
    }
    const double least = options.least_share * (loss + gain) + options.least_gain;
    descent.converged = gain == 0 || (std::isfinite(gain) && gain < least);
  }
  return descent;
}

}  // namespace softgrip::sysid
