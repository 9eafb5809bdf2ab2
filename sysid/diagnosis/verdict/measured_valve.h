#pragma once
// Fits a model of the valve to the measured pressure of several logs. Computes the held-out error of the
// model and the uncertainty of its parameters.
// Detects a loss of pressure: the measured pressure is lower than the command by more than scale errors can
// explain. The cause is then a leak or a wrong scale.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/logs/log.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {

/// Fits models of the valve to logs with a measured pressure. The object keeps a reference to the logs, so
/// the logs must outlive the object.
class MeasuredValve {
 public:
  /// @param held  true: the command is constant between two samples.
  MeasuredValve(const std::vector<Log>& logs, bool held);

  /// Fits the parameters of `parts` to all logs. With the default `sensor`, the gain and the zero offset of
  /// the pressure sensor are fitted too. The fits start at the points `from`.
  [[nodiscard]] ValveStage fit(ValveParts parts, const std::vector<ValveStage>& from,
                               PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;
  /// Returns the result of fit() with a tolerance that is so small that the parameters can be reported.
  [[nodiscard]] ValveStage exact_fit(ValveParts parts, const std::vector<ValveStage>& from) const;

  /// Returns the better one of two fits of `parts`: `one`, and a fit that starts at `other`. `other` was
  /// fitted with only some of the parts. The second fit is made only if the RMSE of `other` is less than 1.5
  /// times the RMSE of `one`.
  [[nodiscard]] ValveStage better_fit(ValveParts parts, const ValveStage& one, const ValveStage& other) const;

  /// Returns the mean square error of the predicted pressure in each block [kPa^2]. The model that predicts a
  /// block is fitted to the fold that does not contain the block.
  [[nodiscard]] BlockLosses held_out_losses(
      ValveParts parts, const ValveStage& whole,
      PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// Returns the standard errors of parameters that were fitted together, in the order and the units of the
  /// parameters. Two estimates are computed, and the larger one is returned. The first estimate assumes white
  /// noise. The second estimate is the sandwich estimate from sums over whole blocks, which includes the
  /// correlation within a block (White, Econometrica 48, 1980; Liang & Zeger, Biometrika 73, 1986). The
  /// sandwich estimate alone is too small if few blocks contain most of the information, for example the
  /// edges of a few steps.
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
  std::size_t samples_ = 0;  ///< number of samples in all logs
  double block_s_;
  std::vector<std::size_t> blocks_end_;  ///< for each log, index of the first block after the log
};

/// Largest relative difference between the scales of the regulator and of the pressure sensor that does not
/// count as a loss of pressure. According to data sheets, each of the two scales has an error of 1 %.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< parts of the valve model, including the leak
  ValveStage stage;  ///< parameters of the valve model with the leak; the gain of the pressure sensor is
                     ///< fixed at 1
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< losses of the model without a leak; the gain of the pressure sensor is fixed
                             ///< at 1
  double highest_kpa = 0;    ///< highest measured pressure
  double missing_kpa = 0;    ///< pressure that is lost when the measured pressure is at its highest value
};

/// Searches for a leak. Returns nullopt in three cases:
/// - The fitted gain of the pressure sensor is at least 1 - scales_agree_within.
/// - A leak reduces the mean square error of the model without leak by less than half.
/// - A leak reduces this error by less than 95 % of the reduction that the fitted sensor gain achieves.
/// @param scaled  fit of `parts` without a leak; gain and zero offset of the pressure sensor are fitted.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
