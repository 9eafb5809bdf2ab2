#pragma once
// Computes how far two fitted structures differ in a future experiment.

#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/noise_model.h"

namespace softgrip::sysid {

/// A structure that may be true, with the information that the existing records contain about its parameters.
class Hypothesis {
 public:
  /// `records` must outlive this object.
  Hypothesis(const std::vector<Record>& records, StructureFit fit, const NoiseModel& noise);

  [[nodiscard]] const StructureFit& fit() const noexcept { return fit_; }
  /// Returns the prediction for a record that starts from rest.
  [[nodiscard]] std::vector<double> prediction(const Record& record) const;
  /// Returns the distance to `truth_mm` in standard deviations of the noise, where `truth_mm` is the
  /// prediction of another hypothesis for `record`. The parameters are first adjusted to `truth_mm` as far as
  /// the existing records permit. The model is linearised.
  [[nodiscard]] double linear_distance(const Record& record, const std::vector<double>& truth_mm) const;
  /// Returns the same distance after a few nonlinear iterations of a fit to the existing records and the new
  /// one.
  [[nodiscard]] double refitted_distance(const Record& record, const std::vector<double>& truth_mm) const;

 private:
  const std::vector<Record>& records_;
  StructureFit fit_;
  NoiseModel noise_;
  std::vector<std::size_t> free_;
  Eigen::MatrixXd information_;  ///< information matrix of the parameters after elimination of the initial
                                 ///< states
};

/// Returns the innovations of a series in units of their standard deviation. The innovations are white if the
/// noise model is correct.
[[nodiscard]] std::vector<double> whitened(const std::vector<double>& series, const NoiseModel& noise);

}  // namespace softgrip::sysid
