#pragma once
// Command to measured pressure, judged by the measured pressure: dead time and a lag for filling and for
// venting.

#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct ValveStage {
  double delay_s = 0;
  double filling_s = 0;
  double venting_s = 0;
  double rmse_kpa = 0;           ///< of the fitted samples
  double rmse_percent = 0;       ///< of the measured pressure's range
  double held_out_rmse_kpa = 0;  ///< of the continuation; 0 where everything was fitted
  double noise_kpa = 0;          ///< of the measured pressure, sample to sample
  bool converged = false;
};

/// Fits the first `share` of every log. Every log needs a pressure_kpa column; each begins at its first
/// measured pressure, wherever the command is.
[[nodiscard]] ValveStage fit_valve_stage(const std::vector<Log>& logs, double share, bool held);

/// The measured pressure that the stage predicts for a log [kPa].
[[nodiscard]] std::vector<double> predicted_pressure_kpa(const ValveStage& stage, const Log& log, bool held);

/// The model with the stage's blocks in front.
[[nodiscard]] model::Model with_valve(model::Model actuator, const ValveStage& stage);

}  // namespace softgrip::sysid
