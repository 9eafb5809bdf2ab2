#pragma once
// Simulates the response of a model to a pressure command, as a log.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Samples a test signal from 0 to its end. displacement_mm is empty.
[[nodiscard]] Log sampled_signal(model::SignalName signal, double rate_hz);

struct SimulationSettings {
  /// Standard deviation of white noise that is added to the noise of the model's own sensor blocks.
  double noise_mm = 0;
  std::uint64_t seed = 1;  ///< seed of all noise
  /// If true, the command of a sample is held until the next sample, as a board holds its output. A reading
  /// then does not depend on the command of its own sample.
  bool held = false;
};

/// Fills the readings of a log with the response of the model, in the output unit of the model. Unless `held`
/// is set, the command is piecewise linear between samples. The simulation starts with a single rise to the
/// first command, which was then held. If the log contains supply_kpa or temperature_c, they are inputs of
/// the model. Equal inputs and settings give identical results.
void simulate(const model::Model& model, const SimulationSettings& settings, Log& log);

}  // namespace softgrip::sysid
