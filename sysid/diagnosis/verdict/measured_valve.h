#pragma once
// The measured pressure of a few logs and the fits of a valve stage to it: what is left of blocks that were
// not fitted, and how certain the numbers are.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/logs/log.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {

/// Refers to its logs, which outlive it. Each has a measured pressure.
class MeasuredValve {
 public:
  /// @param held  the command keeps its value until the next sample.
  MeasuredValve(const std::vector<Log>& logs, bool held);

  /// A fit of some parts, and the gauge, to everything; `tolerance`: of one that is told to the last digits.
  [[nodiscard]] ValveStage fit(ValveParts parts, const std::vector<ValveStage>& from, double tolerance = 1e-6,
                               PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// The better of `one`, a fit of `parts`, and of one that begins at `other`, which has some of them; the
  /// latter is tried where `other` leaves not much more than `one`.
  [[nodiscard]] ValveStage better_fit(ValveParts parts, const ValveStage& one, const ValveStage& other) const;

  /// Mean square of every block while it was not fitted, blocks taking turns [kPa^2].
  [[nodiscard]] BlockLosses held_out_losses(
      ValveParts parts, const ValveStage& whole,
      PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// Standard errors of numbers that were fitted together, in their units and order. The larger of two: of
  /// white noise; and by the sandwich whose filling is the sum over whole blocks, so that what resembles
  /// itself within a block counts once (White, Econometrica 48, 1980; Liang & Zeger, Biometrika 73, 1986).
  /// That one is too small where few blocks say most: the edges of a few steps.
  [[nodiscard]] Eigen::VectorXd standard_errors(const ValveStage& at,
                                                const std::vector<double ValveStage::*>& numbers) const;

 private:
  [[nodiscard]] ValveFit fit_of(ValveParts parts, const std::vector<ValveStage>& from,
                                PressureSensorFit sensor) const;
  [[nodiscard]] std::size_t block(std::size_t log, std::size_t sample) const;
  [[nodiscard]] Eigen::VectorXd errors(const ValveStage& stage) const;
  [[nodiscard]] Eigen::VectorXd derivative(const ValveStage& at, double ValveStage::*number) const;

  const std::vector<Log>& logs_;
  bool held_;
  std::size_t samples_ = 0;              ///< of all logs
  std::vector<std::size_t> blocks_end_;  ///< of every log, one behind its last
};

}  // namespace softgrip::sysid
