#pragma once
// Defines the settings of one channel as plain values, in the units of the rig file. The caller checks the
// settings (settings_problems() in settings.h); the controller does not check them again.

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
  /// True: the channel has an input for the measured pressure (a monitor output of the valve).
  bool pressure_measured = false;
  /// False: the displacement sensor is absent, or the work blocks it. Its readings are recorded. However,
  /// they cause no faults and are not used for feedback or detection. Then only pressure targets are
  /// possible, and only the weaker verification by pressure.
  bool displacement_used = true;
};

}  // namespace softgrip::control
