#pragma once
// Fits the published element: a Bouc-Wen element with two Kelvin-Voigt branches. In the signal path, a delay
// and a lag precede the element.

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

/// Fits the element by searches from `starts` start points.
/// @param drive  Drive::measured: the model has neither a delay nor a lag.
[[nodiscard]] PublishedElement fit_published(const std::vector<Record>& records, Drive drive,
                                             std::size_t starts, std::uint64_t seed);
/// Fits the element to records whose sample times equal those of an earlier fit. `from` is the result of the
/// earlier fit, and the new fit starts there.
[[nodiscard]] FitPoint refit_published(const std::vector<Record>& records, const FitPoint& from);

/// Returns true if the displacement increases with the pressure in every state of the element. This holds if
/// beta times the maximum slope of the hysteretic state is less than alpha + 1/k0.
[[nodiscard]] bool rises_everywhere(const model::Model& model);

/// Returns the indices of the fitted parameters in the list of all parameters. The exponent and k0 are not
/// fitted. The data determine only the sum of alpha and 1/k0, so k0 is constant.
[[nodiscard]] std::vector<std::size_t> free_numbers(const model::Model& model);

}  // namespace softgrip::sysid
