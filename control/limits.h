#pragma once
// What a command may be. apply() is the only place where a pressure is clamped or slowed down.

namespace softgrip::control {

/// Limits of one channel. There is no default that would do for a rig: every field comes from the rig file.
struct LimitSettings {
  double pressure_min_kpa = 0;
  double pressure_max_kpa = 0;        ///< > pressure_min_kpa
  double slew_up_kpa_per_s = 0;       ///< > 0; how fast the command may rise
  double slew_down_kpa_per_s = 0;     ///< > 0; how fast it may fall
  double displacement_min_mm = 0;     ///< references are kept at or above
  double displacement_max_mm = 0;     ///< > displacement_min_mm; references are kept at or below
  double displacement_margin_mm = 0;  ///< >= 0; a reading further out than this beyond the range is a fault
};

}  // namespace softgrip::control
