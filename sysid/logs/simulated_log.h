#pragma once
// Simulates the response of a model to the pressure command of a log.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns a log with the command of a test signal at the sampling rate `rate_hz`, from time 0 to the end of
/// the signal. The log contains no readings.
[[nodiscard]] Log sampled_signal(model::SignalName signal, double rate_hz);

struct SimulationSettings {
  /// Standard deviation of white noise [mm]. This noise is added to the noise of the model's own sensor
  /// blocks.
  double noise_mm = 0;
  std::uint64_t seed = 1;  ///< seed of the added noise and of the noise of the model
  /// True: the command of a sample is held until the next sample, as a board holds its output. A reading then
  /// does not depend on the command of the same sample.
  bool held = false;
};

/// Fills the readings of a log with the response of the model, in the output unit of the model. If `held` is
/// false, the command is piecewise linear between samples. Before the first sample, the command rises once to
/// its first value and is then held. If the log contains supply_kpa or temperature_c, they are inputs of the
/// model. Equal inputs and settings give identical results.
void simulate(const model::Model& model, const SimulationSettings& settings, Log& log);

}  // namespace softgrip::sysid
