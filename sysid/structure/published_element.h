#pragma once
// Fits the published element (Bouc-Wen with two Kelvin-Voigt branches), preceded by a delay and a lag.

#include <cstdint>
#include <vector>

#include "sysid/fitting/fit_space.h"

namespace softgrip::sysid {

struct PublishedElement {
  FitPoint point;
  double rmse_mm = 0;
  bool converged = false;
  std::vector<double> start_rmse_mm;
};

/// Fits the element from `starts` start points.
/// @param drive  Drive::measured: the element has no delay and no lag.
[[nodiscard]] PublishedElement fit_published(const std::vector<Record>& records, Drive drive,
                                             std::size_t starts, std::uint64_t seed);
/// Fits the element to records with the same samples, starting from the point `from`.
[[nodiscard]] FitPoint refit_published(const std::vector<Record>& records, const FitPoint& from);

/// Returns true if the displacement increases with the pressure in every state. This is the case if beta
/// times the maximum slope of the hysteretic state is less than alpha + 1/k0.
[[nodiscard]] bool rises_everywhere(const model::Model& model);

/// Returns the flat indices of the free parameters: all except the exponent and k0. k0 is fixed, because the
/// data determine only the sum of alpha and 1/k0.
[[nodiscard]] std::vector<std::size_t> free_numbers(const model::Model& model);

}  // namespace softgrip::sysid
