#pragma once
// What one channel's control needs to know: plain values, in the units of the rig file. Whoever makes them
// checks them (settings_problems() in settings.h); control takes them as they are.

#include <string>

#include "model/model.h"

namespace softgrip::control {

/// What happens to the integrator while the output is limited.
enum class AntiWindup {
  none,              ///< integrates on
  conditional,       ///< integrates only what leads out of the limit
  back_calculation,  ///< is pulled back by what the limits took away
};

/// Gains of the PID with two degrees of freedom. All gains at 0 switch it off.
struct PidSettings {
  double proportional_kpa_per_mm = 0;  ///< >= 0
  double integral_kpa_per_mm_s = 0;    ///< >= 0
  double derivative_kpa_s_per_mm = 0;  ///< >= 0, on the measurement
  double setpoint_weight = 1;          ///< [0, 1], of the reference in the proportional part
  double derivative_filter_s = 0.02;   ///< > 0, time constant of the filter of the derivative
  AntiWindup anti_windup = AntiWindup::back_calculation;
  double back_calculation_s = 0.5;  ///< > 0, tracking time of back_calculation
};

/// The model-based part of the command.
enum class FeedforwardKind {
  none,
  bouc_wen,    ///< inverse of the Bouc-Wen part alone, as published
  full_model,  ///< implicit inverse of the whole actuator, lead for lag, preview for delay
};

/// The only limits that a command passes. No defaults that mean "none": every number is explicit.
struct LimitSettings {
  double pressure_min_kpa = 0;       ///< lowest command
  double pressure_max_kpa = 60;      ///< highest command
  double slew_up_kpa_per_s = 100;    ///< > 0
  double slew_down_kpa_per_s = 100;  ///< > 0
  double displacement_min_mm = -5;   ///< a valid reading below is a fault
  double displacement_max_mm = 40;   ///< a valid reading above is a fault; bounds references too
};

/// When a reading is not believed.
struct PlausibilitySettings {
  double max_age_s = 0.05;              ///< older: stale
  double max_speed_mm_per_s = 500;      ///< faster between two samples: jumped
  double jump_band_mm = 0.5;            ///< a change within this is never a jump (noise)
  double frozen_after_s = 1.0;          ///< not changed for so long ...
  double frozen_model_change_mm = 1.0;  ///< ... while the running model moved by at least this: frozen
};

/// Monitoring of the residual between the readings and the running model.
struct HealthSettings {
  double sigma_mm = 0.1;               ///< standard deviation of the residual of a fit model (its RMSE)
  double false_alarm_every_s = 3.6e5;  ///< mean time between false alarms that is accepted
};

/// One finger.
struct ChannelSettings {
  std::string name;
  model::Model model;  ///< of the free finger, without contact
  PidSettings pid;
  FeedforwardKind feedforward = FeedforwardKind::full_model;
  LimitSettings limits;
  PlausibilitySettings plausibility;
  HealthSettings health;
};

}  // namespace softgrip::control
