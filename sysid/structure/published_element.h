#pragma once
// The published element (Bouc-Wen with two Kelvin-Voigt branches) behind a delay and a lag, with its own
// search.

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

/// From many starts. @param drive  Drive::measured: without delay and lag.
[[nodiscard]] PublishedElement fit_published(const std::vector<Record>& records, Drive drive,
                                             std::size_t starts, std::uint64_t seed);
/// From where it stands, for records of the same samples.
[[nodiscard]] FitPoint refit_published(const std::vector<Record>& records, const FitPoint& from);

/// Whether it rises with the pressure everywhere: beta times its steepest slope is below alpha + 1/k0.
[[nodiscard]] bool rises_everywhere(const model::Model& model);

/// What a fit of it may move, by flat index: everything but the exponent and k0 (which enters with alpha as
/// one sum).
[[nodiscard]] std::vector<std::size_t> free_numbers(const model::Model& model);

}  // namespace softgrip::sysid
