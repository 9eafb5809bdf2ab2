#pragma once
// Defines the settings of one channel, in the units of the rig file. The caller checks the settings with
// settings_problems() (settings.h); the controller does not check them.

#include <string>

#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "control/elements/model_health.h"
#include "control/elements/pid.h"
#include "control/elements/plausibility.h"
#include "model/model.h"

namespace softgrip::control {

/// Settings of one finger.
struct ChannelSettings {
  std::string name;
  model::Model model;  ///< model of the free finger, without contact
  PidSettings pid;
  FeedforwardSettings feedforward;
  LimitSettings limits;
  PlausibilitySettings plausibility;
  ModelHealthSettings health;
  /// True: the channel has an input for the measured pressure, for example a monitor output of the valve.
  bool pressure_measured = false;
  /// False: the channel has no usable displacement sensor, for example because the work blocks the sensor.
  /// The readings are recorded, but they cause no faults and are not used for feedback or detection. Such a
  /// channel can only have pressure targets, and a grip can only be verified by pressure.
  bool displacement_used = true;
};

}  // namespace softgrip::control
