// This is the only file that includes the solver of Ceres.

#include "sysid/fitting/minimise.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "base/thread_budget.h"

namespace softgrip::sysid {
namespace {

/// Switches off the log messages of Ceres, which uses glog. The summary of the solver contains the relevant
/// information.
void quieten_log() {
  static std::once_flag once;
  std::call_once(once, [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    if (!google::IsGoogleLoggingInitialized()) google::InitGoogleLogging("softgrip");
  });
}

/// Cost function of Ceres that contains all residuals. Ceres would apply Huber's loss to the sum of squares
/// of all residuals. Therefore this class applies Huber's loss to each residual. For |r| > d, the residual is
/// replaced by f = sign(r) sqrt(2 d |r| - d^2), whose square is Huber's cost.
class WholeTrajectory final : public ceres::CostFunction {
 public:
  WholeTrajectory(const Residuals& residuals, double huber_mm) : residuals_(residuals), huber_mm_(huber_mm) {
    set_num_residuals(static_cast<int>(residuals.count()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(residuals.space().size()));
  }

  bool Evaluate(double const* const* parameters, double* r, double** jacobians) const override {
    if (is_cancelled()) return false;  // Ceres does not permit exceptions in this function
    const std::size_t rows = residuals_.count();
    const std::size_t columns = residuals_.space().size();
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    const std::span<double> jacobian(wanted ? jacobians[0] : nullptr, wanted ? rows * columns : 0);
    if (!residuals_.evaluate({parameters[0], columns}, {r, rows}, jacobian)) return false;
    if (!std::isfinite(huber_mm_)) return true;
    for (std::size_t i = 0; i < rows; ++i) {
      const double size = std::abs(r[i]);
      if (size <= huber_mm_) continue;
      const double root = std::sqrt(2 * huber_mm_ * size - huber_mm_ * huber_mm_);
      for (std::size_t c = 0; c < columns && wanted; ++c) jacobian[i * columns + c] *= huber_mm_ / root;
      r[i] = std::copysign(root, r[i]);
    }
    return true;
  }

 private:
  const Residuals& residuals_;
  double huber_mm_;
};

struct PlainFunctor {
  const PlainResiduals& residuals;
  std::size_t numbers;
  std::size_t count;

  bool operator()(double const* const* parameters, double* r) const {
    if (is_cancelled()) return false;
    residuals({parameters[0], numbers}, {r, count});
    return true;
  }
};

double rmse(const Residuals& residuals, const std::vector<double>& z) {
  std::vector<double> r(residuals.count());
  if (!residuals.evaluate(z, r, {})) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const double value : r) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(r.size(), 1)));
}

}  // namespace

Minimum minimise(const Residuals& residuals, std::vector<double> z, const MinimiseOptions& options) {
  quieten_log();
  const std::vector<FreeParameter>& free = residuals.space().free();
  Minimum minimum;
  if (free.empty()) {
    minimum.rmse_mm = rmse(residuals, z);
    minimum.converged = true;
    return minimum;
  }
  ceres::Problem problem;
  problem.AddResidualBlock(new WholeTrajectory(residuals, options.huber_mm), nullptr, z.data());
  for (std::size_t i = 0; i < free.size(); ++i) {
    z[i] = std::clamp(z[i], free[i].lower_z(), free[i].upper_z());
    problem.SetParameterLowerBound(z.data(), static_cast<int>(i), free[i].lower_z());
    problem.SetParameterUpperBound(z.data(), static_cast<int>(i), free[i].upper_z());
  }
  if (options.held && z.size() == 1) {
    problem.SetParameterBlockConstant(z.data());
  } else if (options.held) {
    problem.SetManifold(
        z.data(), new ceres::SubsetManifold(static_cast<int>(z.size()), {static_cast<int>(*options.held)}));
  }
  ceres::Solver::Options solver;
  solver.logging_type = ceres::SILENT;
  solver.linear_solver_type = options.normal_equations ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
  solver.num_threads = 1;
  solver.max_num_iterations = options.most_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-10;
  solver.gradient_tolerance = 0;
  solver.initial_trust_region_radius = 1e3;
  // If there are bounds, Ceres by default searches along each step and computes the derivatives at each trial
  // point. This line search is switched off here, because Ceres limits the steps to the bounds even without a
  // line search.
  solver.max_num_line_search_step_size_iterations = 0;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  end_if_cancelled();
  minimum.cost = summary.final_cost;
  minimum.iterations = static_cast<int>(summary.iterations.size());
  minimum.converged = summary.termination_type == ceres::CONVERGENCE;
  minimum.rmse_mm = std::isfinite(options.huber_mm)
                        ? rmse(residuals, z)
                        : std::sqrt(2 * summary.final_cost / static_cast<double>(residuals.count()));
  minimum.z = std::move(z);
  return minimum;
}

PlainMinimum minimise_plain(const PlainResiduals& residuals, std::size_t count, std::vector<double> start,
                            double tolerance) {
  if (start.empty()) {
    std::vector<double> r(count);
    residuals({}, r);
    return {{}, std::inner_product(r.begin(), r.end(), r.begin(), 0.0)};
  }
  quieten_log();
  auto* cost = new ceres::DynamicNumericDiffCostFunction<PlainFunctor, ceres::CENTRAL>(
      new PlainFunctor{residuals, start.size(), count});
  cost->AddParameterBlock(static_cast<int>(start.size()));
  cost->SetNumResiduals(static_cast<int>(count));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, start.data());
  ceres::Solver::Options solver;
  solver.logging_type = ceres::SILENT;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.num_threads = 1;
  solver.max_num_iterations = 100;
  solver.function_tolerance = tolerance;
  solver.gradient_tolerance = 0;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  end_if_cancelled();
  return {std::move(start), 2 * summary.final_cost};
}

}  // namespace softgrip::sysid
