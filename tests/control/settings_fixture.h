#pragma once
// Settings and sequences for tests.

#include <string>

#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "model/model.h"

namespace softgrip::control {

/// config/models/bench_twin.yaml, read once.
const model::Model& twin();

/// Two channels, left and right, with full_model and low PID gains. The safe action is hold in the phase
/// holding and vent in all others.
RigSettings two_finger_settings();
/// two_finger_settings() with a range from -40 to 60 kPa, the rest pressure 0 kPa, and displacements down to
/// -30 mm.
RigSettings vacuum_settings();

/// Reads a sequence from YAML text and prepares it for a rig. The test fails if the rig refuses it.
PreparedSequence sequence_of(const std::string& yaml, const RigSettings& settings);
/// Reads a sequence of config/sequences/ and prepares it for a rig.
PreparedSequence example_sequence(const std::string& name, const RigSettings& settings);
/// Reads the sequence of config/vacuum/ and prepares it for a rig.
PreparedSequence vacuum_grip(const RigSettings& settings);

}  // namespace softgrip::control
