#pragma once
// Fits the published element (Bouc-Wen with two Kelvin-Voigt branches). A delay and a lag come before the
// element.

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

/// Fits the element with searches from `starts` start points.
/// @param drive  Drive::measured: the element has neither a delay nor a lag.
[[nodiscard]] PublishedElement fit_published(const std::vector<Record>& records, Drive drive,
                                             std::size_t starts, std::uint64_t seed);
/// Fits the element to records with the same samples as before, starting at the point `from`.
[[nodiscard]] FitPoint refit_published(const std::vector<Record>& records, const FitPoint& from);

/// Returns true if the displacement increases with the pressure in every state. This is the case if beta
/// times the maximum slope of the hysteretic state is less than alpha + 1/k0.
[[nodiscard]] bool rises_everywhere(const model::Model& model);

/// Returns the indices of the fitted parameters in the list of all parameters. All parameters except the
/// exponent and k0 are fitted. The data determine only the sum of alpha and 1/k0, so k0 is fixed.
[[nodiscard]] std::vector<std::size_t> free_numbers(const model::Model& model);

}  // namespace softgrip::sysid
