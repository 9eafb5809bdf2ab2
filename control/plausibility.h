#pragma once
// Judges readings that are electrically sound: fresh, not frozen, not faster than the finger can be.

namespace softgrip::control {

struct PlausibilitySettings {
  double max_age_s = 0.05;          ///< > 0; an older reading is stale
  double max_speed_mm_per_s = 500;  ///< > 0; faster than the finger can ever move
  double jump_margin_mm = 0.5;      ///< >= 0; allowed on top, for the sensor's noise
  double frozen_after_s = 1.0;      ///< > 0; how long the reading may stand still while the command moves
  double frozen_band_mm = 0;        ///< >= 0; changes up to this are standing still (a quantisation step)
  double frozen_command_kpa = 10;   ///< > 0; the command must have travelled this far in that time
};

}  // namespace softgrip::control
