#pragma once
// Defines the waveforms of the proposed experiments: curves of the commanded pressure over time. A waveform
// begins and ends at zero pressure.

#include <string>
#include <vector>

namespace softgrip::sysid {

/// Limits of the pressure command that a rig permits.
struct RigLimits {
  double pressure_max_kpa = 60;
  double slew_kpa_per_s = 300;
};

/// A point between two straight segments of a command.
struct Corner {
  double time_s = 0;
  double pressure_kpa = 0;
};

/// A possible waveform for an experiment. Its slew rate is below the limit of the rig.
struct Waveform {
  std::string name;   ///< id of the waveform, for example "rest_and_repeat"
  std::string about;  ///< description of the waveform in one line for the user
  std::vector<Corner> corners;

  [[nodiscard]] double duration_s() const { return corners.empty() ? 0 : corners.back().time_s; }
};

/// Returns all waveforms for experiments: rests between repeated loads, triangles at three rates, steps with
/// holds, minor loops, increasing amplitudes, and sharp steps. All waveforms are within the limits of the
/// rig. If the slew limit permits it, the fastest triangles are 100 times faster than the slowest ones.
[[nodiscard]] std::vector<Waveform> experiment_menu(const RigLimits& limits);

/// Returns the command at intervals of `interval_s` from time 0 to the end of the waveform.
[[nodiscard]] std::vector<double> sampled_kpa(const Waveform& waveform, double interval_s);

}  // namespace softgrip::sysid
