#pragma once
// Simulates the recording of a grip without the daemon. The grip consists of a rest, closing until contact, a
// hold, the release, and a rest without pressure.

#include <cstdint>

#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

/// Changes of the finger, its supply line and its sensor, and the conditions of a simulated grip.
struct GripWorld {
  double gain = 1;
  double zero_mm = 0;
  double lag_s = 0;
  double extra_creep_mm = 0;  ///< decrease of the displacement [mm] during the last second of the run
  double loop_mm = 0;         ///< additional displacement [mm] while the pressure falls
  double loss_kpa = 0;
  double leak_kpa_per_s = 0;
  double object_mm = 12;  ///< position of the object [mm]; infinite if there is no object
  double rise_s = 3;      ///< duration of the closing phase [s]
  double noise_mm = 0.02;
  bool measures_pressure = true;
  std::uint64_t seed = 1;
};

/// Returns the recording of a grip with one channel, `left`, sampled at 100 Hz. Its commands go up to
/// `grip_kpa`.
[[nodiscard]] Recording grip_of(const GripWorld& world);

/// Largest command of a grip [kPa].
inline constexpr double grip_kpa = 40;

}  // namespace softgrip::sysid::health
