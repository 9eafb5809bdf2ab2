#pragma once
// Ranks many starts of a candidate without a fit of each. It adds the effect of a start to the prediction and
// lets the base respond linearly.

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "model/model.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A point in the parameters of a structure, with the derivatives of its prediction. For a start whose effect
/// on the prediction is d, the scan minimises the mean square of r + a d + J delta. delta is a small change
/// of the structure's parameters (one damped Gauss-Newton step). a is within [0.7, 1.4], because the size of
/// a start is only approximate.
class Scan {
 public:
  /// @param records  must outlive the scan.
  Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place);

  [[nodiscard]] const FitPoint& place() const noexcept { return place_; }
  /// Returns false if the prediction or its derivatives are not finite. No start can then be ranked.
  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// Returns the mean square that the structure with this block would reach [mm^2], or infinity if it is
  /// undetermined.
  [[nodiscard]] double mean_square_with(const model::BlockSpec& block) const;
  /// Returns the columns over all readings after projection: without the part that the structure's own
  /// parameters can absorb.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& columns) const;
  /// Returns the place after its parameters moved within their bounds. The move is a `share` of the linear
  /// step that removes as much of a residual as they can.
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
  Eigen::VectorXd left_;      ///< the part that the structure cannot absorb
};

/// Smallest number of starts of a cause that are tested.
inline constexpr std::size_t fewest_looks = 2;

/// Returns the most promising starts of a cause, best first and its free form last. Every form of the cause
/// is included, because a form with more parameters always promises more. Every place is included too: a base
/// whose refit absorbed the effect and a base that did not lead to different minima. The next best starts
/// fill the list up to `fewest`.
[[nodiscard]] std::vector<FitPoint> best_starts(std::span<const Scan> scans, const Cause& cause,
                                                const Scales& scales, std::size_t fewest);

}  // namespace softgrip::sysid
