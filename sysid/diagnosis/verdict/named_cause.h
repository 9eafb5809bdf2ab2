#pragma once
// Describes a cause that is named in a verdict, with the evidence for the cause, its parameters and their
// confidence intervals. The value of a parameter depends on the other causes in the structure. If the data do
// not show if a confounded cause is present, the interval covers the values with and without the confounded
// cause.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/diagnosis/residual/sampling.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/identification/identify.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {

/// A parameter of a named cause.
struct CauseParameter {
  std::string name;
  std::string unit;
  double value = 0;
  Interval ci95;
  bool has_interval = false;
  std::string formerly = {};  ///< deprecated name, which JSON files also contain; empty: none

  [[nodiscard]] bool determined() const { return has_interval && is_determined(ci95, value); }
};

struct NamedCause : ChosenCause {
  std::size_t block_type = 0;  ///< type of the block that represents the cause in the model
  std::vector<CauseParameter> parameters;
  /// Reduction of the mean square error of the measured pressure [kPa^2]. Not set: the cause was not found in
  /// the measured pressure.
  std::optional<Spread> gain_kpa2;
  /// True: only one-step predictions of closed loops show the cause (loop_valve.h). Its error reductions and
  /// its inclusion frequency were then not measured and are NaN.
  bool only_in_loop = false;
};

/// A fitted point and the covariance of its fitted parameters.
struct UncertainPoint {
  const FitPoint& point;
  const FitSpace& space;
  std::vector<double> z;
  Uncertainty uncertainty;
};
/// Computes the covariance of the parameters that were fitted at `point`.
/// @param space  free parameters of the fit to `records`. `point` and `space` must outlive the result.
[[nodiscard]] UncertainPoint uncertain_point(const std::vector<Record>& records, const FitPoint& point,
                                             const FitSpace& space);

/// Returns the parameters of the block with the type `block_type`. A parameter has a 95 % interval only if it
/// was fitted and is not at a bound.
[[nodiscard]] std::vector<CauseParameter> block_numbers(const UncertainPoint& at, std::size_t block_type);

/// Returns the causes of a selection. Their parameters have the values of the extended model.
[[nodiscard]] std::vector<NamedCause> name_chosen(const std::vector<Record>& records,
                                                  const StructureFit& extended,
                                                  const std::vector<ChosenCause>& chosen);

/// Returns the causes that were detected in the readings before any fit. These are outliers, and slow or
/// frozen sampling.
[[nodiscard]] std::vector<NamedCause> causes_in_readings(const OutlierEvidence& outliers,
                                                         const SamplingEvidence& sampling, double noise_mm,
                                                         model::OutputUnit unit);

/// Returns the title of a cause with a lower-case first letter, so that it can be used within a sentence:
/// "valve lag".
[[nodiscard]] std::string title_within(const Cause& cause);
/// Returns the title of an alternative, for example "valve lag". If the same cause is already named, "a
/// further" is added: "a further valve lag".
[[nodiscard]] std::string alternative_title(const Cause& alternative, const std::vector<NamedCause>& named);

/// Returns true if the list of named causes contains the cause.
[[nodiscard]] bool is_among(const std::vector<NamedCause>& named, const Cause& cause);

/// Returns true if at least one of the named causes has an alternative.
[[nodiscard]] bool any_alternatives(const std::vector<NamedCause>& causes);

/// Widens the intervals of `named`, which are the causes of `selection`. Each interval then also covers the
/// values of the parameter in the undecided structures of the selection that the held-out losses do not rule
/// out. Returns one sentence for each undecided structure that has widened an interval.
[[nodiscard]] std::vector<std::string> mix_intervals(std::vector<NamedCause>& named,
                                                     const std::vector<Record>& records,
                                                     const Selection& selection, std::uint64_t seed);

}  // namespace softgrip::sysid
