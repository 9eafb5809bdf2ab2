#pragma once
// How far apart two fitted structures would be on a record that does not exist yet.

#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/identification/noise_model.h"

namespace softgrip::sysid {

/// A structure that could be true, and what the existing records say about its parameters.
class Hypothesis {
 public:
  /// `records` outlives this.
  Hypothesis(const std::vector<Record>& records, StructureFit fit, const NoiseModel& noise);

  [[nodiscard]] const StructureFit& fit() const noexcept { return fit_; }
  /// What it predicts for a record that starts from rest.
  [[nodiscard]] std::vector<double> prediction(const Record& record) const;
  /// Distance [noise deviations] that remains to `truth_mm` (the other's prediction on `record`) when the
  /// parameters move as far as the existing records let them: linearised.
  [[nodiscard]] double linear_distance(const Record& record, const std::vector<double>& truth_mm) const;
  /// The same after a few true iterations of a fit over the existing records and the new one.
  [[nodiscard]] double refitted_distance(const Record& record, const std::vector<double>& truth_mm) const;

 private:
  const std::vector<Record>& records_;
  StructureFit fit_;
  NoiseModel noise_;
  std::vector<std::size_t> free_;
  Eigen::MatrixXd information_;  ///< about the model's parameters, the records' starts eliminated
};

/// A series as its innovations, in deviations of them: white where the noise is as modelled.
[[nodiscard]] std::vector<double> whitened(const std::vector<double>& series, const NoiseModel& noise);

}  // namespace softgrip::sysid
