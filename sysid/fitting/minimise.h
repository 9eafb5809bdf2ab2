#pragma once
// Least squares with bounds from a given start, with the trust region method of Ceres.

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sysid/fitting/residuals.h"

namespace softgrip::sysid {

struct MinimiseOptions {
  int most_iterations = 60;
  /// Residuals above this limit have a linear cost instead of a quadratic one (Huber). Infinity: none.
  double huber_mm = std::numeric_limits<double>::infinity();
  /// Index of a parameter that is fixed.
  std::optional<std::size_t> held;
  /// Normal equations instead of an orthogonal factorisation. They are several times faster and have half the
  /// digits, which is sufficient if only the error of the fit is used.
  bool normal_equations = false;
  /// Relative change of the cost at which the search ends.
  double tolerance = 1e-10;
};

struct Minimum {
  std::vector<double> z;
  double rmse_mm = 0;  ///< of the residuals without Huber's loss
  double cost = 0;     ///< half the sum of squares, or of Huber's loss
  int iterations = 0;
  bool converged = false;
};

/// @param z  the start; it is first limited to the bounds.
[[nodiscard]] Minimum minimise(const Residuals& residuals, std::vector<double> z,
                               const MinimiseOptions& options = {});

/// Computes the residuals `r` at the point `p`.
using PlainResiduals = std::function<void(std::span<const double> p, std::span<double> r)>;

struct PlainMinimum {
  std::vector<double> p;
  double sum_of_squares = 0;
};

/// Minimises over a few parameters, or none, without bounds. Derivatives are central differences.
/// @param count  number of residuals.
/// @param tolerance  relative change of the cost at which the search ends.
[[nodiscard]] PlainMinimum minimise_plain(const PlainResiduals& residuals, std::size_t count,
                                          std::vector<double> start, double tolerance = 1e-12);

}  // namespace softgrip::sysid
