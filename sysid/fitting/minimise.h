#pragma once
// Least squares with bounds from a given point, by Ceres' trust region.

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
  /// Residuals beyond it count linearly instead of by their square (Huber); infinity: never.
  double huber_mm = std::numeric_limits<double>::infinity();
  /// Index of a parameter that keeps its value.
  std::optional<std::size_t> held;
  /// Normal equations instead of an orthogonal factorisation: several times faster, half the digits. Enough
  /// where a fit is judged by its error, not by its last digits.
  bool normal_equations = false;
  /// Relative change of the cost at which the search ends.
  double tolerance = 1e-10;
};

struct Minimum {
  std::vector<double> z;
  double rmse_mm = 0;  ///< of the residuals as they are, without Huber
  double cost = 0;     ///< half the sum of squares, beyond huber_mm the linear part
  int iterations = 0;
  bool converged = false;
};

/// @param z  the start, brought within the bounds first.
[[nodiscard]] Minimum minimise(const Residuals& residuals, std::vector<double> z,
                               const MinimiseOptions& options = {});

/// Fills `r` at the point `p`.
using PlainResiduals = std::function<void(std::span<const double> p, std::span<double> r)>;

struct PlainMinimum {
  std::vector<double> p;
  double sum_of_squares = 0;
};

/// Of a few numbers, or none, without bounds that are no model's, with differences for derivatives.
/// @param count  how many residuals.
/// @param tolerance  relative change of the cost at which the search ends.
[[nodiscard]] PlainMinimum minimise_plain(const PlainResiduals& residuals, std::size_t count,
                                          std::vector<double> start, double tolerance = 1e-12);

}  // namespace softgrip::sysid
