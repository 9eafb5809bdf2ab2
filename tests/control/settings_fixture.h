#pragma once
// Settings and sequences for tests.

#include <string>

#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "model/model.h"

namespace softgrip::control {

/// config/models/bench_twin.yaml, read once.
const model::Model& twin();

/// Two channels, left and right, full_model with a mild PID; vent everywhere but hold while holding.
RigSettings two_finger_settings();
/// two_finger_settings() from -40 to 60 kPa with the rest pressure 0 kPa, and down to -30 mm.
RigSettings vacuum_settings();

/// A sequence out of YAML text, fitted to a rig; the test fails when it does not fit.
PreparedSequence sequence_of(const std::string& yaml, const RigSettings& settings);
/// One of config/sequences/, fitted to a rig.
PreparedSequence example_sequence(const std::string& name, const RigSettings& settings);
/// The one of config/vacuum/, fitted to a rig.
PreparedSequence vacuum_grip(const RigSettings& settings);

}  // namespace softgrip::control
