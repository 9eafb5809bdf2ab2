#pragma once
// Ranks many start points of a candidate without fitting the structure from each of them. The effect of a
// start point is added to the prediction, and the parameters of the base structure respond linearly.

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Ranks start points of causes at one point in the parameters of a structure. The scan uses the derivatives
/// J of the prediction and the residual r at this point. If a start point changes the prediction by d, the
/// scan minimises the mean square of r + a d + J delta over a and delta. delta is a small change of the
/// structure's parameters (one damped Gauss-Newton step). The factor a is in [0.7, 1.4], because the size of
/// the effect is only approximate.
class Scan {
 public:
  /// @param records  records; they must outlive the scan.
  Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place);

  [[nodiscard]] const FitPoint& place() const noexcept { return place_; }
  /// Returns false if the prediction or one of its derivatives is not finite. In this case, no start point
  /// can be ranked.
  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// Returns the mean square that the structure would reach if this block were added [mm^2]. Returns infinity
  /// if the prediction with the block is not finite.
  [[nodiscard]] double mean_square_with(const model::BlockSpec& block) const;
  /// Returns the columns after removal of the part that the parameters of the structure can absorb. A column
  /// has one row per reading.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& columns) const;
  /// Returns the point after a step of the parameters of the structure within their bounds. The full linear
  /// step would remove as much of `residual` as possible. The returned point includes only `share` of this
  /// step.
  [[nodiscard]] FitPoint answer_to(const Eigen::VectorXd& residual, double share) const;

 private:
  [[nodiscard]] Eigen::VectorXd residual_at(const model::Model& model) const;

  const std::vector<Record>& records_;
  FitPoint place_;
  FitSpace space_;  ///< space of the parameters of the structure
  bool usable_ = false;
  Eigen::MatrixXd jacobian_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd residual_;  ///< prediction minus reading, for each reading
  Eigen::VectorXd left_;      ///< part of `residual_` that the parameters of the structure cannot absorb
};

/// Returns the best start points of a cause, the best one first. Start points of its free form come last. The
/// list contains the best start point of every form, because a form with more parameters always has a smaller
/// mean square in the scan. It also contains the best start point of every scan, because fits from different
/// scans may end at different minima. Further start points are added until the list has `fewest` elements.
[[nodiscard]] std::vector<FitPoint> best_starts(std::span<const Scan> scans, const Cause& cause,
                                                const Scales& scales, std::size_t fewest);

}  // namespace softgrip::sysid
