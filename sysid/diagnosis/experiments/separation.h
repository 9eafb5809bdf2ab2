#pragma once
// Predicts how far the responses of two fitted models would differ in a future experiment.

#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {

/// A fitted model structure that may be true, and the information that the existing records give about its
/// parameters.
class Hypothesis {
 public:
  /// `records` must outlive this object.
  Hypothesis(const std::vector<Record>& records, StructureFit fit, const NoiseModel& noise);

  [[nodiscard]] const StructureFit& fit() const noexcept { return fit_; }
  /// Returns the prediction for a record that starts from rest.
  [[nodiscard]] std::vector<double> prediction(const Record& record) const;
  /// Returns the distance between `truth_mm` and the prediction of this hypothesis, in standard deviations of
  /// the noise. `truth_mm` is the response of another hypothesis to `record`. Before the comparison, the
  /// parameters of this hypothesis are fitted to `truth_mm` and to the existing records. The fit uses a
  /// linearised model.
  [[nodiscard]] double linear_distance(const Record& record, const std::vector<double>& truth_mm) const;
  /// Returns the same distance as linear_distance(), but the parameters are fitted by a few iterations of a
  /// nonlinear fit. The fit uses the existing records and the new record.
  [[nodiscard]] double refitted_distance(const Record& record, const std::vector<double>& truth_mm) const;

 private:
  const std::vector<Record>& records_;
  StructureFit fit_;
  NoiseModel noise_;
  std::vector<std::size_t> free_;
  /// Information matrix of the parameters, without the initial states, which were eliminated.
  Eigen::MatrixXd information_;
};

/// Whitens a series: returns its innovations under the noise model, divided by their standard deviation. If
/// the noise model is correct, the result is white noise.
[[nodiscard]] std::vector<double> whitened(const std::vector<double>& series, const NoiseModel& noise);

}  // namespace softgrip::sysid
