#pragma once
// Defines the waveforms of the proposed experiments: pressures over time that a rig can execute. They begin
// and end at zero pressure.

#include <string>
#include <vector>

namespace softgrip::sysid {

/// Limits of a rig for its pressure commands.
struct RigLimits {
  double pressure_max_kpa = 60;
  double slew_kpa_per_s = 300;
};

/// A corner of a piecewise linear command.
struct Corner {
  double time_s = 0;
  double pressure_kpa = 0;
};

/// One waveform that an experiment can apply. Its slew rate never exceeds the limit of the rig.
struct Waveform {
  std::string name;   ///< id of the waveform: "rest_and_repeat"
  std::string about;  ///< description of the waveform in one line, for display
  std::vector<Corner> corners;

  [[nodiscard]] double duration_s() const { return corners.empty() ? 0 : corners.back().time_s; }
};

/// Returns all waveforms that experiments can apply: rest and repeat; triangles at three rates that span a
/// factor of 100; steps with holds; minor loops; increasing amplitudes; sharp steps. All waveforms are within
/// the limits of the rig.
[[nodiscard]] std::vector<Waveform> experiment_menu(const RigLimits& limits);

/// Returns the command at times from 0 to the end of the waveform, at intervals of `interval_s`.
[[nodiscard]] std::vector<double> sampled_kpa(const Waveform& waveform, double interval_s);

}  // namespace softgrip::sysid
