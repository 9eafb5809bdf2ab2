#pragma once
// Ranks many start points of a candidate without a fit of each. The effect of a start point is added to the
// prediction, and the parameters of the base structure respond linearly.

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A point in the parameters of a structure, with the derivatives of its prediction. For a start point of a
/// cause whose effect on the prediction is d, the scan minimises the mean square of r + a d + J delta. r is
/// the residual, J contains the derivatives, and delta is a small change of the structure's parameters (one
/// damped Gauss-Newton step). The factor a is within [0.7, 1.4], because the size of the effect is only
/// approximate.
class Scan {
 public:
  /// @param records  records that must outlive the scan.
  Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place);

  [[nodiscard]] const FitPoint& place() const noexcept { return place_; }
  /// Returns false if the prediction or its derivatives are not finite, so that no start point can be ranked.
  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// Returns the mean square that the structure would reach with this block added [mm^2], or infinity if the
  /// prediction is undefined.
  [[nodiscard]] double mean_square_with(const model::BlockSpec& block) const;
  /// Returns the columns (one row per reading) without the part that the parameters of the structure can
  /// absorb.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& columns) const;
  /// Returns the point after a step of the structure's parameters, within their bounds. The step is a `share`
  /// of the linear step that removes as much of `residual` as possible.
  [[nodiscard]] FitPoint answer_to(const Eigen::VectorXd& residual, double share) const;

 private:
  [[nodiscard]] Eigen::VectorXd residual_at(const model::Model& model) const;

  const std::vector<Record>& records_;
  FitPoint place_;
  FitSpace space_;  ///< parameters of the structure
  bool usable_ = false;
  Eigen::MatrixXd jacobian_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd residual_;  ///< prediction minus reading
  Eigen::VectorXd left_;      ///< part of the residual that the structure's parameters cannot absorb
};

/// Smallest number of start points that are tested for a cause.
inline constexpr std::size_t fewest_looks = 2;

/// Returns the most promising start points of a cause, the best first and those of its free form last. The
/// best start point of every form is included, because a form with more parameters always reaches a smaller
/// mean square in the scan. The best start point of every scan is included as well: a fit from a base
/// structure that has absorbed the effect may end in a different minimum than a fit from one that has not.
/// The next best start points are added until the list has `fewest` elements.
[[nodiscard]] std::vector<FitPoint> best_starts(std::span<const Scan> scans, const Cause& cause,
                                                const Scales& scales, std::size_t fewest);

}  // namespace softgrip::sysid
