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

/// A place in the parameters of a structure, with the derivatives of its prediction there. For a start, whose
/// effect on the prediction is d, the mean square of r + a d + J delta is minimised over the small movement
/// delta of the structure's own parameters (one Gauss-Newton step, damped as a minimiser's first) and over a
/// within [0.7, 1.4], as a start need not have quite the right size.
class Scan {
 public:
  /// @param records  must outlive the scan.
  Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place);

  [[nodiscard]] const FitPoint& place() const noexcept { return place_; }
  /// False: the prediction or its derivatives are not finite, so no start can be ranked from here.
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
  FitSpace space_;  ///< the structure's own numbers
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
