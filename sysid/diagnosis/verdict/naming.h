#pragma once
// What is said of a cause: its numbers with their intervals.

#include <cstddef>
#include <string>
#include <vector>

#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {

/// A fitted point with the covariance of what its fit moved.
struct UncertainPoint {
  const FitPoint& point;
  const FitSpace& space;
  std::vector<double> z;
  Uncertainty uncertainty;
};
/// @param space  what the fit to `records` moved; both must outlive the result.
[[nodiscard]] UncertainPoint uncertain_point(const std::vector<Record>& records, const FitPoint& point,
                                             const FitSpace& space);

/// The numbers of the model's block of this type, in its order; intervals of 95 % where the fit moved them
/// and they are not at a bound.
[[nodiscard]] std::vector<CauseParameter> block_numbers(const UncertainPoint& at, std::size_t block_type);

/// The causes that a search chose, as they stand in its extended structure.
[[nodiscard]] std::vector<NamedCause> name_chosen(const std::vector<Record>& records,
                                                  const StructureFit& extended,
                                                  const std::vector<ChosenCause>& chosen);

[[nodiscard]] NamedCause outlier_cause(const OutlierEvidence& evidence, double noise_mm);

/// A cause in the midst of a sentence: "valve lag".
[[nodiscard]] std::string title_within(const Cause& cause);
/// A rival beside what is named: "a further valve lag" where one is named already.
[[nodiscard]] std::string rival_title(const Cause& rival, const std::vector<NamedCause>& named);

/// Whether the cause is among those that are named.
[[nodiscard]] bool is_among(const std::vector<NamedCause>& named, const Cause& cause);

/// Whether any of them has a rival.
[[nodiscard]] bool any_rivals(const std::vector<NamedCause>& causes);

}  // namespace softgrip::sysid
