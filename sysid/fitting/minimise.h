#pragma once
// Solves least-squares problems with bounds from a given start point by damped Gauss-Newton steps
// (descent.h).

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sysid/fitting/residuals.h"

namespace softgrip::sysid {

struct MinimiseOptions {
  int most_iterations = 60;  ///< maximum number of trial steps
  /// Limit of a residual above which its cost is linear instead of quadratic (Huber). Infinity: all costs are
  /// quadratic.
  double huber_mm = std::numeric_limits<double>::infinity();
  /// Index of a parameter that is held constant; empty: none.
  std::optional<std::size_t> held;
  /// The search ends when a step changes the cost by less than this share of the cost.
  double tolerance = 1e-10;
};

struct Minimum {
  std::vector<double> z;
  double rmse_mm = 0;  ///< RMSE of the residuals, without Huber's loss
  double cost = 0;     ///< half the sum of squared residuals, or half the sum of Huber's loss
  int iterations = 0;  ///< number of steps that reduced the cost
  bool converged = false;
};

/// Minimises the sum of squared residuals.
/// @param z  start point, which is first clipped to the bounds.
[[nodiscard]] Minimum minimise(const Residuals& residuals, std::vector<double> z,
                               const MinimiseOptions& options = {});

/// Computes the residuals `r` at the point `p`.
using PlainResiduals = std::function<void(std::span<const double> p, std::span<double> r)>;

struct PlainMinimum {
  std::vector<double> p;
  double sum_of_squares = 0;
};

/// Minimises the sum of squared residuals over a few parameters without bounds. The list of parameters may be
/// empty. Derivatives are computed by central differences.
/// @param count  number of residuals.
/// @param tolerance  relative change of the cost at which the search ends.
[[nodiscard]] PlainMinimum minimise_plain(const PlainResiduals& residuals, std::size_t count,
                                          std::vector<double> start, double tolerance = 1e-12);

}  // namespace softgrip::sysid
