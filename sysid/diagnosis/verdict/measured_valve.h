#pragma once
// Fits a valve stage to the measured pressure of several logs, and computes the held-out error and the
// uncertainty of the parameters.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/logs/log.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {

/// Fits valve stages. Keeps a reference to the logs, which must outlive it. Each log must have a measured
/// pressure.
class MeasuredValve {
 public:
  /// @param held  true: the command is constant until the next sample.
  MeasuredValve(const std::vector<Log>& logs, bool held);

  /// Fits the given parts and the pressure sensor to all data, from the start points `from`.
  /// @param tolerance  tolerance of the fit; a fit that is reported needs a small one.
  [[nodiscard]] ValveStage fit(ValveParts parts, const std::vector<ValveStage>& from, double tolerance = 1e-6,
                               PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// Returns the better of two fits of `parts`: `one`, or a fit that starts at `other`, which has some of the
  /// parts. The second fit is only computed if the error of `other` is little larger than that of `one`.
  [[nodiscard]] ValveStage better_fit(ValveParts parts, const ValveStage& one, const ValveStage& other) const;

  /// Returns the mean square of each block under a fit that did not use the block [kPa^2].
  [[nodiscard]] BlockLosses held_out_losses(
      ValveParts parts, const ValveStage& whole,
      PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// Returns standard errors of parameters that were fitted together, in their units and order. The result is
  /// the larger of two estimates. One assumes white noise. The other is the sandwich estimate with sums over
  /// whole blocks, so that correlation within a block is included (White, Econometrica 48, 1980; Liang &
  /// Zeger, Biometrika 73, 1986). The sandwich estimate is too small if few blocks contain most of the
  /// information, such as the edges of a few steps.
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
  std::size_t samples_ = 0;              ///< number of samples in all logs
  std::vector<std::size_t> blocks_end_;  ///< index after the last block of each log
};

}  // namespace softgrip::sysid
