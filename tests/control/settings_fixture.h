#pragma once
// Settings of simulated rigs and prepared sequences for the tests of the controller.

#include <string>

#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "model/model.h"

namespace softgrip::control {

/// Returns the model config/models/bench_twin.yaml. The file is read once.
const model::Model& twin();

/// Returns settings with two channels, left and right, the full_model feedforward and low PID gains. The safe
/// action is hold in the phase holding, and vent in all other phases.
RigSettings two_finger_settings();
/// Returns two_finger_settings() with a pressure range from -40 to 60 kPa, the rest pressure 0 kPa, and
/// displacements down to -30 mm.
RigSettings vacuum_settings();

/// Reads a sequence from YAML text and prepares it for a rig. If the rig refuses the sequence, the test
/// fails.
PreparedSequence sequence_of(const std::string& yaml, const RigSettings& settings);
/// Reads a sequence in config/sequences/ and prepares it for a rig.
PreparedSequence example_sequence(const std::string& name, const RigSettings& settings);
/// Reads the sequence vacuum_grip in config/vacuum/ and prepares it for a rig.
PreparedSequence vacuum_grip(const RigSettings& settings);

}  // namespace softgrip::control
