#pragma once
// Simulates the response of a model to a pressure command, as a log.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

/// Samples a test signal from 0 to its end. displacement_mm is empty.
[[nodiscard]] sysid::Log sampled_signal(model::SignalName signal, double rate_hz);

struct SimulationSettings {
  double noise_mm = 0;  ///< standard deviation of white noise, in addition to the model's own sensor blocks
  std::uint64_t seed = 1;  ///< seed of all noise
  /// If true, the command of a sample is held until the next sample, as a board holds its output. A reading
  /// then does not depend on the command of its own sample.
  bool held = false;
};

/// Fills the readings of a log with the response of the model, in its unit. Unless `held`, the command is
/// piecewise linear between samples. Before the first sample, the command rose once to its first value and
/// was held. supply_kpa and temperature_c of the log are inputs of the model if they exist. Equal inputs and
/// settings give identical results.
void simulate(const model::Model& model, const SimulationSettings& settings, sysid::Log& log);

}  // namespace softgrip::tools
