#pragma once
// Errors and fits in the healthy runs. The search for a change compares the later readings with them.

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/base.h"
#include "sysid/changes/change_intervals.h"
#include "sysid/changes/later_readings.h"
#include "sysid/evidence/tolerance.h"

namespace softgrip::sysid {

/// Returns the mean square of whitened readings over the bins; about 1 for healthy readings.
[[nodiscard]] double per_bin(const LaterReadings& readings, const Eigen::VectorXd& white);

/// Searches for effects in each healthy unit. The prediction comes from a fit to the other units.
[[nodiscard]] std::vector<HealthyFits> healthy_fits(const Base& base, bool pressure_is_judged,
                                                    unsigned threads);

/// Returns the tolerance of the search from the error reductions in the healthy units.
[[nodiscard]] Tolerance tolerance_of(const std::vector<HealthyFits>& healthy, std::size_t runs);

/// Errors of healthy units, each predicted by a fit to all other healthy units, and the largest permitted
/// error of another healthy run.
class RunSpread {
 public:
  RunSpread() = default;
  RunSpread(const std::vector<HealthyFits>& healthy, std::size_t runs);
  [[nodiscard]] double usual_rms() const { return std::sqrt(mean_square_); }
  [[nodiscard]] double allowed_rms() const { return std::sqrt(factor_ * mean_square_); }
  /// Returns true if the error exceeds the largest error that is expected in another healthy run.
  /// @param rms  RMS error of the readings without whitening.
  /// @param loss  mean square of the whitened readings; 1 for healthy units.
  [[nodiscard]] bool is_exceeded(double rms, double loss) const {
    return rms > allowed_rms() || loss > factor_;
  }
  /// Returns true if the error is large enough for a search for a change. If there are several healthy runs,
  /// the tolerance of the search is known. The error then only has to exceed that of each healthy run.
  [[nodiscard]] bool admits_a_change(double rms, double loss) const {
    return is_exceeded(rms, loss) || (are_runs_ && (rms > worst_rms_ || loss > worst_loss_));
  }

 private:
  double factor_ = 1, mean_square_ = 0, worst_rms_ = 0, worst_loss_ = 0;
  bool are_runs_ = false;
};

}  // namespace softgrip::sysid
