#pragma once
// Command to measured pressure, judged by the measured pressure: dead time, a lag for filling and for
// venting, and what else a valve may do.

#include <bitset>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// What may stand between command and measured pressure, in the order in which the signal meets it.
enum class ValvePart : std::uint8_t {
  delay,
  dead_band,
  lag,
  two_ways,  ///< of the lag: another time constant while it vents
  supply_sag,
  limit,
  second_lag,  ///< behind the other, both ways alike
  leak,
};
inline constexpr std::size_t valve_part_count = 8;
using ValveParts = std::bitset<valve_part_count>;

[[nodiscard]] constexpr std::size_t index_of(ValvePart part) {
  return static_cast<std::size_t>(part);
}
/// Dead time and a lag for either direction: what every valve has.
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
  double second_s = 0;            ///< of the second lag
  double coupling = 0;            ///< share of a relative loss of supply that reaches the pressure
  double nominal_supply_kpa = 0;  ///< the loss is counted from here; 0: the supply is not recorded
  double limit_kpa = std::numeric_limits<double>::infinity();
  double leak_share = 0;  ///< of a small pressure, lost on the way (model/line_loss.h)
  double gauge_gain = 1;  ///< of the pressure's sensor
  double gauge_zero_kpa = 0;
  double rmse_kpa = 0;           ///< of the fitted samples
  double rmse_percent = 0;       ///< of the measured pressure's range
  double held_out_rmse_kpa = 0;  ///< of the others; 0 where everything was fitted
  bool converged = false;

  /// It leaves more than a twentieth of the range: the valve is another thing than these parts.
  [[nodiscard]] bool is_far_off() const { return rmse_percent > 5; }
};

/// What is fitted of the pressure's sensor.
enum class PressureSensorFit : std::uint8_t { nothing, zero, gain_and_zero };

/// What is fitted, and to which samples.
struct ValveFit {
  ValveParts parts = usual_valve_parts();
  PressureSensorFit sensor = PressureSensorFit::nothing;
  bool held = false;  ///< the command keeps its value until the next sample
  /// Empty: all samples.
  std::function<bool(std::size_t log, std::size_t sample)> is_fitted = {};
  std::vector<ValveStage> from = {};  ///< the search begins at each of them; empty: at three usual ones
  double tolerance = 1e-12;           ///< relative change of the cost at which it ends
};

/// Every log needs a pressure_kpa column, and a supply_kpa column where parts hold supply_sag; each begins at
/// its first measured pressure, wherever the command is.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, const ValveFit& fit);
/// The usual parts, fitted to the first `share` of every log.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, double share, bool held);

/// Of the measured pressure, from sample to sample: the largest of the logs' [kPa].
[[nodiscard]] double pressure_noise_kpa(const std::vector<Log>& logs);

/// The measured pressure that the stage predicts for a log [kPa].
[[nodiscard]] std::vector<double> predicted_pressure_kpa(const ValveStage& stage, const Log& log, bool held);

/// The model with the stage's blocks in front.
[[nodiscard]] model::Model with_valve(model::Model actuator, const ValveStage& stage);

}  // namespace softgrip::sysid
