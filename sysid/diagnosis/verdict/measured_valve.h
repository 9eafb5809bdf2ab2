#pragma once
// Fits a model of the valve to the measured pressure of several logs. Computes the held-out error and the
// uncertainty of its parameters.
// Detects that the measured pressure stays below the command by more than scale errors can explain. The cause
// is then a leak or a wrong scale.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/logs/log.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {

/// Fits models of the valve. The object keeps a reference to the logs, which must outlive it. Each log must
/// contain a measured pressure.
class MeasuredValve {
 public:
  /// @param held  true: the command is constant between two samples.
  MeasuredValve(const std::vector<Log>& logs, bool held);

  /// Fits the valve model to all data: the parameters of `parts`, and the gain and the zero offset of the
  /// pressure sensor. The fits start at the points `from`.
  /// @param tolerance  tolerance of the fit; it must be small if the result of the fit is reported.
  [[nodiscard]] ValveStage fit(ValveParts parts, const std::vector<ValveStage>& from, double tolerance = 1e-6,
                               PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// Returns the better of two fits of `parts`. The first fit is `one`. The second fit starts at `other`,
  /// which was fitted with only some of the parts. The second fit is computed only if the error of `other` is
  /// at most slightly larger than the error of `one`.
  [[nodiscard]] ValveStage better_fit(ValveParts parts, const ValveStage& one, const ValveStage& other) const;

  /// Returns the mean square error of the predicted pressure in each block [kPa^2]. For each block, the model
  /// is fitted to the fold that does not contain this block.
  [[nodiscard]] BlockLosses held_out_losses(
      ValveParts parts, const ValveStage& whole,
      PressureSensorFit sensor = PressureSensorFit::gain_and_zero) const;

  /// Returns the standard errors of parameters that were fitted together. The result has the units and the
  /// order of these parameters. It is the larger of two estimates. The first assumes white noise. The second
  /// is the sandwich estimate from sums over whole blocks, which includes the correlation within a block
  /// (White, Econometrica 48, 1980; Liang & Zeger, Biometrika 73, 1986). The sandwich estimate is too small
  /// if few blocks contain most of the information, for example the edges of a few steps.
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
  std::vector<std::size_t> blocks_end_;  ///< for each log, the index after its last block
};

/// Largest difference between the scales of the regulator and of the pressure sensor that is explained
/// without a leak. Each of the two scales has an error of 1 % according to its data sheet.
inline constexpr double scales_agree_within = 0.015;

struct LostPressure {
  ValveParts parts;  ///< parts of the valve model, including the leak
  ValveStage stage;  ///< parameters of the valve model with the leak; the sensor gain is 1
  BlockLosses losses_kpa2;
  BlockLosses without_kpa2;  ///< losses of the model without a leak and with a sensor gain of 1
  double highest_kpa = 0;    ///< highest measured pressure
  double missing_kpa = 0;    ///< lost pressure when the measured pressure has its highest value
};

/// Searches for a leak. Returns nullopt in three cases. First, the fitted gain of the pressure sensor is
/// within the scale errors. Second, a model with a leak fits significantly worse than a model with this gain.
/// Third, most of the error that remains without leak and gain has another cause.
/// @param scaled  fit of `parts`, which contain no leak, with gain and zero offset of the pressure sensor.
[[nodiscard]] std::optional<LostPressure> find_lost_pressure(const std::vector<Log>& logs,
                                                             const MeasuredValve& valve, ValveParts parts,
                                                             const ValveStage& scaled);

}  // namespace softgrip::sysid
