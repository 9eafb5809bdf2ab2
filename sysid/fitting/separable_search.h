#pragma once
// Searches for the parameters of a separable chain from inaccurate start points. The method is variable
// projection (Golub and Pereyra 1973, with the simplification by Kaufman 1975) with damped steps (descent.h).
//
// For given nonlinear parameters, the linear parameters are the solution of normal equations with bounds.
// Reading the data once gives the Gram matrix of all columns. The cost, the gradient and the Gauss-Newton
// matrix of the reduced problem are computed from this matrix, so no array has the size of the data.

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sysid/fitting/descent.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/separable.h"

namespace softgrip::sysid {

/// Result of a search from one start point.
struct SearchResult {
  FitPoint point;
  double rmse_mm = 0;
  int iterations = 0;
  bool converged = false;
};

/// A search that is prepared for many start points. run() is thread-safe.
class SeparableSearch {
 public:
  /// Prepares a search. Returns nullopt if the chain is not separable. Also returns nullopt if `space` does
  /// not make the following parameters free: alpha or k0, beta, and k and c of each branch. gamma and eta
  /// must be both free or both fixed.
  /// @param records  records that must outlive the search.
  [[nodiscard]] static std::optional<SeparableSearch> make(const std::vector<Record>& records,
                                                           const FitSpace& space);

  /// Searches from the nonlinear parameters of `start`. The linear parameters of `start` have no effect.
  /// @param damping  damping of the first step. A small value gives a Gauss-Newton step, a large one a short
  /// step along the gradient.
  [[nodiscard]] SearchResult run(const FitPoint& start, double damping = 1e-3) const;

 private:
  /// A nonlinear parameter and its bounds in the scale of the search. Rates are logarithmic. The other
  /// parameters (growing, eta, delay, lag and peak) are divided by a typical size.
  struct Coordinate {
    enum class Kind { growing, eta, rate, delay, lag, peak };
    Kind kind;
    std::size_t index = 0;  ///< index of the branch or of the record to which the parameter belongs
    double scale = 1;
    double lower = 0;
    double upper = 0;
  };
  /// The linear parameters that are optimal for given nonlinear parameters.
  struct Linear {
    Eigen::VectorXd values;
    std::vector<bool> at_bound;
    double cost = 0;  ///< sum of the squared residuals [mm^2]
  };
  struct Descending;
  struct FreeParts;

  SeparableSearch(const std::vector<Record>& records, const FitSpace& space, const SeparableShape& shape,
                  const FreeParts& parts);

  void add_coordinates(const FreeParts& parts);
  void add_linear(const FreeParts& parts);
  [[nodiscard]] Eigen::VectorXd coordinates_of(const SeparablePoint& point) const;
  [[nodiscard]] SeparablePoint moved(SeparablePoint point, const Eigen::VectorXd& q) const;
  void set_linear(SeparablePoint& point, const Eigen::VectorXd& values) const;
  [[nodiscard]] Linear project(const SeparablePoint& point) const;
  /// Returns the normal equations of the reduced problem, which depends only on the nonlinear parameters.
  [[nodiscard]] NormalEquations normal(const SeparablePoint& point, const Linear& linear) const;
  [[nodiscard]] Eigen::MatrixXd coordinate_map(const SeparablePoint& point, std::size_t record) const;
  [[nodiscard]] FitPoint to_fit_point(FitPoint start, const SeparablePoint& point) const;
  /// Returns, for each linear column of a record, its index among all linear parameters; -1: the parameter is
  /// fixed.
  [[nodiscard]] std::vector<Eigen::Index> places(std::size_t record) const;

  std::shared_ptr<const FitSpace> space_;
  SeparableShape shape_;
  std::vector<SeparableRecord> records_;
  std::vector<Coordinate> coordinates_;
  /// For each record, the index of the first linear parameter that belongs to this record only.
  std::vector<Eigen::Index> first_own_;
  std::vector<bool> offset_free_;  ///< true: the offset of the record is free
  std::vector<double> lower_;      ///< lower bounds of the linear parameters
  std::vector<double> upper_;
  bool alpha_free_ = false;
  std::size_t residual_count_ = 0;
};

}  // namespace softgrip::sysid
