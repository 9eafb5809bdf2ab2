#pragma once
// Describes a cause: its parameters with their intervals.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/diagnosis/residual/sampling.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {

/// A fitted point with the covariance of the fitted parameters.
struct UncertainPoint {
  const FitPoint& point;
  const FitSpace& space;
  std::vector<double> z;
  Uncertainty uncertainty;
};
/// @param space  the parameters that the fit to `records` moved; both must outlive the result.
[[nodiscard]] UncertainPoint uncertain_point(const std::vector<Record>& records, const FitPoint& point,
                                             const FitSpace& space);

/// Returns the parameters of the model's block of this type, in its order. A parameter has a 95 % interval if
/// the fit moved it and it is not at a bound.
[[nodiscard]] std::vector<CauseParameter> block_numbers(const UncertainPoint& at, std::size_t block_type);

/// Returns the causes of a selection with their parameters in the extended structure.
[[nodiscard]] std::vector<NamedCause> name_chosen(const std::vector<Record>& records,
                                                  const StructureFit& extended,
                                                  const std::vector<ChosenCause>& chosen);

/// Returns the causes that are found in the readings before any fit: outliers and sampling, if they are
/// present.
[[nodiscard]] std::vector<NamedCause> causes_in_readings(const OutlierEvidence& outliers,
                                                         const SamplingEvidence& sampling, double noise_mm,
                                                         model::OutputUnit unit);

/// Returns the title of a cause for use inside a sentence: "valve lag".
[[nodiscard]] std::string title_within(const Cause& cause);
/// Returns the title of an alternative next to the named causes: "a further valve lag" if a valve lag is
/// already named.
[[nodiscard]] std::string alternative_title(const Cause& alternative, const std::vector<NamedCause>& named);

/// Returns true if the cause is named.
[[nodiscard]] bool is_among(const std::vector<NamedCause>& named, const Cause& cause);

/// Returns true if any of the causes has an alternative.
[[nodiscard]] bool any_alternatives(const std::vector<NamedCause>& causes);

}  // namespace softgrip::sysid
