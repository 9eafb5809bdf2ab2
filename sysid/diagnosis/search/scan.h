#pragma once
// Judging many starts of a candidate without fitting any: what the effect of a start adds to the prediction,
// with the base answering linearly.

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A place in the parameters of a structure, with the derivatives of its prediction there. For a start, whose
/// effect on the prediction is d, the mean square of r + a d + J delta is minimised over the small movement
/// delta of the structure's own parameters (one Gauss-Newton step, damped as a minimiser's first) and over a
/// within [0.7, 1.4], as a start need not have quite the right size.
class Scan {
 public:
  /// @param records  must outlive the scan.
  Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place);

  [[nodiscard]] const FitPoint& place() const noexcept { return place_; }
  /// False where the prediction or its derivatives are not finite: nothing can be said from here.
  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// What mean square the structure with this block would reach [mm^2]; infinity when it cannot be told.
  [[nodiscard]] double mean_square_with(const model::BlockSpec& block) const;
  /// Columns over all readings without what the structure's own parameters could take away.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& columns) const;
  /// The place, its numbers moved within their bounds by a `share` of what would take away all that they can
  /// of a residual, if they were linear.
  [[nodiscard]] FitPoint answer_to(const Eigen::VectorXd& residual, double share) const;

 private:
  [[nodiscard]] Eigen::VectorXd residual_at(const model::Model& model) const;

  const std::vector<Record>& records_;
  FitPoint place_;
  FitSpace space_;  ///< the structure's own numbers
  bool usable_ = false;
  Eigen::MatrixXd jacobian_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd residual_;  ///< prediction minus reading
  Eigen::VectorXd left_;      ///< of it
};

/// Starts of a cause that are looked at.
inline constexpr std::size_t fewest_looks = 2;

/// The most promising starts of a cause, best first and its free form last: one of every form that the cause
/// has, since the form with more numbers always promises more, and one from every place, since a base that
/// was recalibrated to swallow the effect and one that was not lead to different valleys. The next best ones
/// make up for what is missing to `fewest`.
[[nodiscard]] std::vector<FitPoint> best_starts(std::span<const Scan> scans, const Cause& cause,
                                                const Scales& scales, std::size_t fewest);

}  // namespace softgrip::sysid
