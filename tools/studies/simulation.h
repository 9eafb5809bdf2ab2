#pragma once
// What a model answers to a pressure command, as a log.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

/// The samples of a test signal from 0 to its end; displacement_mm is empty.
[[nodiscard]] sysid::Log sampled_signal(model::SignalName signal, double rate_hz);

struct SimulationSettings {
  double noise_mm = 0;     ///< standard deviation of white noise, besides the model's own sensor blocks
  std::uint64_t seed = 1;  ///< of all noise
  /// The command of a sample is held until the next one, as a board holds its output; a reading does not
  /// depend on the command of its own sample.
  bool held = false;
};

/// Fills the readings of a log with the model's answer, in its unit. Unless it is held, the command is
/// piecewise linear between samples; before the first one, it had risen to its value once and been held.
/// supply_kpa and temperature_c of the log surround the model where they are there. Same input, same
/// settings: same bits.
void simulate(const model::Model& model, const SimulationSettings& settings, sysid::Log& log);

}  // namespace softgrip::tools
