#pragma once
// Model of the valve from command to measured pressure, fitted to the measured pressure: dead time, lags for
// filling and venting, and further effects.

#include <bitset>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Possible parts between command and measured pressure, in the order of the signal.
enum class ValvePart : std::uint8_t {
  delay,
  dead_band,
  lag,
  two_ways,  ///< separate time constant of the lag for venting
  supply_sag,
  limit,
  second_lag,  ///< after the first, with one time constant for both directions
  leak,
};
inline constexpr std::size_t valve_part_count = 8;
using ValveParts = std::bitset<valve_part_count>;

[[nodiscard]] constexpr std::size_t index_of(ValvePart part) {
  return static_cast<std::size_t>(part);
}
/// Returns the parts of every valve: dead time, and a lag with a time constant for each direction.
[[nodiscard]] inline ValveParts usual_valve_parts() {
  return ValveParts()
      .set(index_of(ValvePart::delay))
      .set(index_of(ValvePart::lag))
      .set(index_of(ValvePart::two_ways));
}

struct ValveStage {
  double delay_s = 0;
  double band_kpa = 0;  ///< change of the command after a reversal that the valve ignores
  double filling_s = 0;
  double venting_s = 0;
  double second_s = 0;            ///< time constant of the second lag
  double coupling = 0;            ///< relative drop of the pressure per relative drop of the supply
  double nominal_supply_kpa = 0;  ///< reference of the supply drop; 0: the supply is not recorded
  double limit_kpa = std::numeric_limits<double>::infinity();
  double leak_share = 0;  ///< share of a small pressure that is lost in the line (model/line_loss.h)
  double gauge_gain = 1;  ///< gain of the pressure sensor
  double gauge_zero_kpa = 0;
  double rmse_kpa = 0;           ///< RMSE of the fitted samples
  double rmse_percent = 0;       ///< rmse_kpa in percent of the range of the measured pressure
  double held_out_rmse_kpa = 0;  ///< RMSE of the other samples; 0 if all samples were fitted
  bool converged = false;

  /// Returns true if the RMSE exceeds 5 % of the range, so that these parts do not describe the valve.
  [[nodiscard]] bool is_far_off() const { return rmse_percent > 5; }
};

/// The fitted parameters of the pressure sensor.
enum class PressureSensorFit : std::uint8_t { nothing, zero, gain_and_zero };

/// Parts, samples and starting points of a fit.
struct ValveFit {
  ValveParts parts = usual_valve_parts();
  PressureSensorFit sensor = PressureSensorFit::nothing;
  bool held = false;  ///< the command keeps its value until the next sample
  /// Selects the samples of the fit; empty: all samples.
  std::function<bool(std::size_t log, std::size_t sample)> is_fitted = {};
  std::vector<ValveStage> from = {};  ///< starting points of the search; empty: three default ones
  double tolerance = 1e-12;           ///< relative change of the cost at which the search ends
};

/// Fits a valve. Each log needs a pressure_kpa column, and a supply_kpa column if the parts include
/// supply_sag. The simulation of a log begins at its first measured pressure, regardless of the command.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, const ValveFit& fit);
/// Fits the parts of usual_valve_parts() to the first `share` of each log.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, double share, bool held);

/// Returns the noise of the measured pressure between successive samples: the largest value over the logs
/// [kPa].
[[nodiscard]] double pressure_noise_kpa(const std::vector<Log>& logs);

/// Returns the measured pressure that the stage predicts for a log [kPa].
[[nodiscard]] std::vector<double> predicted_pressure_kpa(const ValveStage& stage, const Log& log, bool held);

/// Returns the model of the actuator with the blocks of the stage before it.
[[nodiscard]] model::Model with_valve(model::Model actuator, const ValveStage& stage);

}  // namespace softgrip::sysid
