#pragma once
// Computes the distance between the responses of two fitted structures in a future experiment.

#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {

/// A model structure that may be true, with the information of the existing records on its parameters.
class Hypothesis {
 public:
  /// `records` must outlive this object.
  Hypothesis(const std::vector<Record>& records, StructureFit fit, const NoiseModel& noise);

  [[nodiscard]] const StructureFit& fit() const noexcept { return fit_; }
  /// Returns the prediction for a record that starts from rest.
  [[nodiscard]] std::vector<double> prediction(const Record& record) const;
  /// Returns the distance between `truth_mm` and the prediction of this hypothesis, in standard deviations of
  /// the noise. `truth_mm` is the prediction of another hypothesis for `record`. The parameters of this
  /// hypothesis are first fitted to `truth_mm` as far as the existing records permit. The fit uses a
  /// linearised model.
  [[nodiscard]] double linear_distance(const Record& record, const std::vector<double>& truth_mm) const;
  /// Returns the same distance as linear_distance(), but with a few iterations of a nonlinear fit to the
  /// existing records and the new record.
  [[nodiscard]] double refitted_distance(const Record& record, const std::vector<double>& truth_mm) const;

 private:
  const std::vector<Record>& records_;
  StructureFit fit_;
  NoiseModel noise_;
  std::vector<std::size_t> free_;
  /// Information matrix of the parameters after elimination of the initial states.
  Eigen::MatrixXd information_;
};

/// Returns the innovations of `series`, divided by their standard deviation. The innovations are white noise
/// if the noise model is correct.
[[nodiscard]] std::vector<double> whitened(const std::vector<double>& series, const NoiseModel& noise);

}  // namespace softgrip::sysid
