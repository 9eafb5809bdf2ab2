#pragma once
// Models the path from the command to the measured pressure and fits this model to the measured pressure. The
// model consists of a dead time, lags for filling and venting, and further parts such as a dead band or a
// pressure limit.

#include <bitset>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Parts that a valve model can have. In the signal path, the second lag directly follows the first lag.
enum class ValvePart : std::uint8_t {
  delay,
  dead_band,
  lag,
  two_ways,  ///< the lag has one time constant for filling and another for venting
  supply_sag,
  limit,
  second_lag,  ///< a second lag after the first lag; its time constant is the same for filling and venting
  leak,
};
inline constexpr std::size_t valve_part_count = 8;
using ValveParts = std::bitset<valve_part_count>;

[[nodiscard]] constexpr std::size_t index_of(ValvePart part) {
  return static_cast<std::size_t>(part);
}
/// Returns the parts of the default valve model: a dead time, and a lag with separate time constants for
/// filling and venting.
[[nodiscard]] inline ValveParts usual_valve_parts() {
  return ValveParts()
      .set(index_of(ValvePart::delay))
      .set(index_of(ValvePart::lag))
      .set(index_of(ValvePart::two_ways));
}

struct ValveStage {
  double delay_s = 0;
  double band_kpa = 0;  ///< dead band: after a reversal, the valve does not respond until the command has
                        ///< changed by this amount
  double filling_s = 0;
  double venting_s = 0;
  double second_s = 0;  ///< time constant of the second lag
  /// Sensitivity of the pressure to the supply: relative decrease of the pressure divided by the relative
  /// decrease of the supply pressure.
  double coupling = 0;
  /// Supply pressure at which the supply does not reduce the pressure; 0: the supply pressure is not
  /// recorded.
  double nominal_supply_kpa = 0;
  double limit_kpa = std::numeric_limits<double>::infinity();
  double leak_share = 0;  ///< share of the pressure that a leak in the line loses at small pressures
                          ///< (model/line_loss.h)
  double gauge_gain = 1;  ///< gain of the pressure sensor
  double gauge_zero_kpa = 0;
  double rmse_kpa = 0;           ///< RMSE of the fitted samples
  double rmse_percent = 0;       ///< rmse_kpa as a percentage of the range of the measured pressure
  double held_out_rmse_kpa = 0;  ///< RMSE of the samples that were left out of the fit; 0 if all samples were
                                 ///< fitted
  bool converged = false;
  /// Names and values of the fitted times that are at the upper limit of the search; empty: none.
  std::vector<std::string> limits_reached = {};

  /// Returns true if the model does not describe the valve, that is, if the RMSE exceeds 5 % of the range of
  /// the measured pressure.
  [[nodiscard]] bool is_far_off() const { return rmse_percent > 5; }
};

/// Parameters of the pressure sensor that are estimated during a fit.
enum class PressureSensorFit : std::uint8_t { nothing, zero, gain_and_zero };

/// Input of a fit of a valve model: its parts, the samples and the start points.
struct ValveFit {
  ValveParts parts = usual_valve_parts();
  PressureSensorFit sensor = PressureSensorFit::nothing;
  bool held = false;  ///< true: the command is constant until the next sample
  /// Function that returns true for the samples that are fitted. Empty: all samples are fitted.
  std::function<bool(std::size_t log, std::size_t sample)> is_fitted = {};
  std::vector<ValveStage> from = {};  ///< start points of the search; empty: default start points
  double tolerance = 1e-12;           ///< relative change of the cost at which the search ends
};

/// Fits a valve model. Each log needs a pressure_kpa column. If the parts include supply_sag, each log also
/// needs a supply_kpa column. The simulation of a log starts at its first measured pressure, even if the
/// first command differs from this pressure. The unit of the default start points and of the limits is
/// time_unit_s(). The limits of dead time and lag are at least 25 % and 50 % of the longest log. If the
/// default start points lead to a limit or to a poor fit, the search is repeated from start points for valves
/// of any speed.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, const ValveFit& fit);
/// Fits the parts of usual_valve_parts(). The fit uses the first part of each log; `share` is its length
/// divided by the length of the log.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, double share, bool held);

/// Returns the noise of the measured pressure [kPa], estimated from consecutive samples. If there are several
/// logs, returns the largest noise.
[[nodiscard]] double pressure_noise_kpa(const std::vector<Log>& logs);

/// Returns the predicted measured pressure at each sample of a log [kPa].
[[nodiscard]] std::vector<double> predicted_pressure_kpa(const ValveStage& stage, const Log& log, bool held);

/// Returns a model that contains the blocks of the valve, followed by the blocks of the actuator.
[[nodiscard]] model::Model with_valve(model::Model actuator, const ValveStage& stage);

}  // namespace softgrip::sysid
