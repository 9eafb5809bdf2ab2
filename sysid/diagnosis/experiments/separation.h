#pragma once
// Computes the distance between the responses of two fitted structures in a future experiment.

#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/noise_model.h"

namespace softgrip::sysid {

/// A structure that may be true, with the information of the existing records on its parameters.
class Hypothesis {
 public:
  /// `records` must outlive this object.
  Hypothesis(const std::vector<Record>& records, StructureFit fit, const NoiseModel& noise);

  [[nodiscard]] const StructureFit& fit() const noexcept { return fit_; }
  /// Returns the prediction for a record that starts from rest.
  [[nodiscard]] std::vector<double> prediction(const Record& record) const;
  /// Returns the distance from the prediction of this hypothesis to `truth_mm`, in standard deviations of the
  /// noise. `truth_mm` is the prediction of another hypothesis for `record`. Before, the parameters are
  /// fitted to `truth_mm` as far as the existing records permit. The model is linearised.
  [[nodiscard]] double linear_distance(const Record& record, const std::vector<double>& truth_mm) const;
  /// Returns the distance of linear_distance() after a few nonlinear iterations of a fit to the existing
  /// records and the new record.
  [[nodiscard]] double refitted_distance(const Record& record, const std::vector<double>& truth_mm) const;

 private:
  const std::vector<Record>& records_;
  StructureFit fit_;
  NoiseModel noise_;
  std::vector<std::size_t> free_;
  /// Information matrix of the parameters after elimination of the initial states.
  Eigen::MatrixXd information_;
};

/// Returns the innovations of a series, divided by their standard deviation. They are white noise if the
/// noise model is correct.
[[nodiscard]] std::vector<double> whitened(const std::vector<double>& series, const NoiseModel& noise);

}  // namespace softgrip::sysid
