#pragma once
// Ranks many start points of a candidate without a fit from each of them. The effect of a start point is
// added to the prediction, and the parameters of the base structure respond linearly to this effect.

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Ranks start points of causes for a structure with given parameters. The scan uses the derivatives J of the
/// prediction and the residual r for these parameters. Let d be the change of the prediction by a start
/// point. The scan minimises the mean square of r + a d + J delta over a and delta. delta is a small change
/// of the parameters (one damped Gauss-Newton step). a is in [0.7, 1.4], because the size of the effect is
/// known only approximately.
class Scan {
 public:
  /// @param records  records, which must outlive the scan.
  Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place);

  [[nodiscard]] const FitPoint& place() const noexcept { return place_; }
  /// Returns true if the prediction and all its derivatives are finite. If the result is false, the scan
  /// cannot rank start points.
  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// Returns the mean square [mm^2] that the scan predicts for the structure with this additional block.
  /// Returns infinity if the prediction with the block is not finite.
  [[nodiscard]] double mean_square_with(const model::BlockSpec& block) const;
  /// Returns the columns without the part that the parameters of the structure can absorb. A column has one
  /// row per reading.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& columns) const;
  /// Returns the point after a linear step of the parameters of the structure, limited to their bounds. The
  /// full step would remove as much of `residual` as possible. The step is multiplied by `share`.
  [[nodiscard]] FitPoint answer_to(const Eigen::VectorXd& residual, double share) const;

 private:
  [[nodiscard]] Eigen::VectorXd residual_at(const model::Model& model) const;

  const std::vector<Record>& records_;
  FitPoint place_;
  FitSpace space_;  ///< space in which the parameters of the structure are changed
  bool usable_ = false;
  Eigen::MatrixXd jacobian_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd residual_;  ///< prediction minus reading, one element per reading
  Eigen::VectorXd left_;      ///< part of `residual_` that the parameters of the structure cannot absorb
};

/// Returns the best start points of a cause, the best one first. Start points of a free form come last. The
/// list contains the best start point of every form, because in the scan, a form with more parameters always
/// has a smaller mean square. The list also contains the best start point of every scan, because fits from
/// different scans may end at different minima. Further start points are added until the list has at least
/// `fewest` elements.
[[nodiscard]] std::vector<FitPoint> best_starts(std::span<const Scan> scans, const Cause& cause,
                                                const Scales& scales, std::size_t fewest);

}  // namespace softgrip::sysid
