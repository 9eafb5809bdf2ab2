#include "sysid/fitting/minimise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include "sysid/fitting/descent.h"

namespace softgrip::sysid {
namespace {

/// Damping of the first trial step, as a share of the curvature.
constexpr double first_damping = 1e-3;
/// Step of a central difference, as a share of the parameter, and its smallest value.
constexpr double relative_difference = 1e-6, least_difference = 1.5e-8;

/// Point of a descent, with the sum of squares at this point. Infinity: the model is not defined there.
struct LeastSquaresPoint {
  std::vector<double> z;
  double sum_of_squares = 0;
};

/// Least squares for descend(). `Evaluate(z, r, jacobian)` computes the residuals and their derivatives. An
/// empty jacobian means that the derivatives are not needed. It returns false if a result is not defined.
template <class Evaluate>
class LeastSquares {
 public:
  LeastSquares(Evaluate evaluate, std::size_t count, std::vector<double> lower, std::vector<double> upper)
      : evaluate_(std::move(evaluate)),
        r_(count),
        jacobian_(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(lower.size())),
        lower_(std::move(lower)),
        upper_(std::move(upper)) {}

  [[nodiscard]] LeastSquaresPoint at(std::vector<double> z) {
    const bool defined = evaluate_(z, std::span(r_), std::span<double>{});
    const double sum = Eigen::Map<const Eigen::VectorXd>(r_.data(), rows()).squaredNorm();
    return {std::move(z), defined && std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity()};
  }

  [[nodiscard]] static double loss(const LeastSquaresPoint& point) { return point.sum_of_squares; }

  [[nodiscard]] NormalEquations normal(const LeastSquaresPoint& point) {
    const Eigen::Index n = columns();
    is_defined_ = evaluate_(point.z, std::span(r_), jacobian());
    if (!is_defined_) return {Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Identity(n, n)};
    const Eigen::Map<const Eigen::VectorXd> r(r_.data(), rows());
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(n, n);
    curvature.selfadjointView<Eigen::Lower>().rankUpdate(jacobian_.transpose());
    curvature.triangularView<Eigen::StrictlyUpper>() = curvature.transpose();
    return {jacobian_.transpose() * r, std::move(curvature)};
  }

  [[nodiscard]] StepBounds bounds(const LeastSquaresPoint& point) const {
    const Eigen::Map<const Eigen::VectorXd> z(point.z.data(), columns()), lower(lower_.data(), columns()),
        upper(upper_.data(), columns());
    return {lower - z, upper - z};
  }

  [[nodiscard]] LeastSquaresPoint moved(const LeastSquaresPoint& from, const Eigen::VectorXd& step) {
    std::vector<double> z = from.z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      z[i] = std::clamp(z[i] + step(static_cast<Eigen::Index>(i)), lower_[i], upper_[i]);
    }
    return at(std::move(z));
  }

  /// Returns true if the derivatives could be computed at the last point.
  [[nodiscard]] bool is_defined() const { return is_defined_; }

 private:
  [[nodiscard]] Eigen::Index rows() const { return jacobian_.rows(); }
  [[nodiscard]] Eigen::Index columns() const { return jacobian_.cols(); }
  [[nodiscard]] std::span<double> jacobian() {
    return {jacobian_.data(), static_cast<std::size_t>(jacobian_.size())};
  }

  Evaluate evaluate_;
  std::vector<double> r_;
  Jacobian jacobian_;
  std::vector<double> lower_, upper_;
  bool is_defined_ = true;
};

/// Replaces each residual by the residual whose square is Huber's cost: f = sign(r) sqrt(2 d |r| - d^2) for
/// |r| > d. Converts the rows of the Jacobian accordingly.
/// @param jacobian  may be empty.
void apply_huber(double huber_mm, std::span<double> r, std::span<double> jacobian) {
  if (!std::isfinite(huber_mm)) return;
  const std::size_t columns = jacobian.size() / std::max<std::size_t>(r.size(), 1);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double size = std::abs(r[i]);
    if (size <= huber_mm) continue;
    const double root = std::sqrt(2 * huber_mm * size - huber_mm * huber_mm);
    for (double& slope : jacobian.subspan(i * columns, columns)) slope *= huber_mm / root;
    r[i] = std::copysign(root, r[i]);
  }
}

double rmse(const Residuals& residuals, const std::vector<double>& z) {
  std::vector<double> r(residuals.count());
  if (!residuals.evaluate(z, r, {})) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const double value : r) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(r.size(), 1)));
}

DescentOptions options_for(int most_iterations, double tolerance) {
  return {.most_steps = most_iterations,
          .most_evaluations = most_iterations,
          .damping = first_damping,
          .rule = DampingRule::gain_ratio,
          .longest_step = std::numeric_limits<double>::infinity(),
          .least_share = tolerance};
}

}  // namespace

Minimum minimise(const Residuals& residuals, std::vector<double> z, const MinimiseOptions& options) {
  const std::vector<FreeParameter>& free = residuals.space().free();
  Minimum minimum;
  if (free.empty()) {
    minimum.rmse_mm = rmse(residuals, z);
    minimum.converged = true;
    return minimum;
  }
  std::vector<double> lower, upper;
  for (std::size_t i = 0; i < free.size(); ++i) {
    z[i] = std::clamp(z[i], free[i].lower_z(), free[i].upper_z());
    const bool held = options.held == i;
    lower.push_back(held ? z[i] : free[i].lower_z());
    upper.push_back(held ? z[i] : free[i].upper_z());
  }
  const auto evaluate = [&](std::span<const double> at, std::span<double> r, std::span<double> jacobian) {
    if (!residuals.evaluate(at, r, jacobian)) return false;
    apply_huber(options.huber_mm, r, jacobian);
    return true;
  };
  LeastSquares problem(evaluate, residuals.count(), std::move(lower), std::move(upper));
  auto end =
      descend(problem, problem.at(std::move(z)), options_for(options.most_iterations, options.tolerance));
  minimum.z = std::move(end.point.z);
  minimum.cost = end.point.sum_of_squares / 2;
  minimum.iterations = end.steps;
  minimum.converged = end.converged && problem.is_defined();
  minimum.rmse_mm = std::isfinite(options.huber_mm)
                        ? rmse(residuals, minimum.z)
                        : std::sqrt(2 * minimum.cost / static_cast<double>(residuals.count()));
  return minimum;
}

PlainMinimum minimise_plain(const PlainResiduals& residuals, std::size_t count, std::vector<double> start,
                            double tolerance) {
  std::vector<double> higher(count), lesser(count);
  const auto evaluate = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    residuals(p, r);
    if (jacobian.empty()) return true;
    std::vector<double> shifted(p.begin(), p.end());
    for (std::size_t c = 0; c < p.size(); ++c) {
      const double step = std::max(relative_difference * std::abs(p[c]), least_difference);
      shifted[c] = p[c] + step;
      residuals(shifted, higher);
      shifted[c] = p[c] - step;
      residuals(shifted, lesser);
      shifted[c] = p[c];
      for (std::size_t i = 0; i < count; ++i)
        jacobian[i * p.size() + c] = (higher[i] - lesser[i]) / (2 * step);
    }
    return std::ranges::all_of(jacobian, [](double slope) { return std::isfinite(slope); });
  };
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  LeastSquares problem(evaluate, count, std::vector<double>(start.size(), -unbounded),
                       std::vector<double>(start.size(), unbounded));
  constexpr int most_iterations = 100;
  auto end = descend(problem, problem.at(std::move(start)), options_for(most_iterations, tolerance));
  return {std::move(end.point.z), end.point.sum_of_squares};
}

}  // namespace softgrip::sysid
