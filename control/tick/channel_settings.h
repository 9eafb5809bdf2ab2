#pragma once
// Defines the settings of one channel as plain values, in the units of the rig file. The caller checks them
// (settings_problems() in settings.h); control does not check them again.

#include <string>

#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "control/elements/model_health.h"
#include "control/elements/pid.h"
#include "control/elements/plausibility.h"
#include "model/model.h"

namespace softgrip::control {

/// One finger.
struct ChannelSettings {
  std::string name;
  model::Model model;  ///< model of the free finger, without contact
  PidSettings pid;
  FeedforwardSettings feedforward;
  LimitSettings limits;
  PlausibilitySettings plausibility;
  ModelHealthSettings health;
  /// The channel has an input for the measured pressure (a monitor output of the valve).
  bool pressure_measured = false;
  /// False: the displacement sensor is absent, or the work blocks it. Its readings are recorded, but they
  /// cause no faults and are not used for feedback or detection. Only pressure targets and verification by
  /// pressure (weaker) are possible.
  bool displacement_used = true;
};

}  // namespace softgrip::control
