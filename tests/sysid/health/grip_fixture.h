#pragma once
// Simulates a recorded grip without the daemon: rest, closing until contact, hold, release, vented finger.

#include <cstdint>

#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

/// Changes of the finger, its supply line and its sensor, and the conditions of the grip.
struct GripWorld {
  double gain = 1;
  double zero_mm = 0;
  double lag_s = 0;
  double extra_creep_mm = 0;  ///< additional displacement at the end of the last second of a run
  double loop_mm = 0;         ///< additional displacement on the return
  double loss_kpa = 0;
  double leak_kpa_per_s = 0;
  double object_mm = 12;  ///< infinite: no object
  double rise_s = 3;      ///< duration of the closing phase
  double noise_mm = 0.02;
  bool measures_pressure = true;
  std::uint64_t seed = 1;
};

/// Returns a recording of one channel, `left`, at 100 Hz, with commands up to `grip_kpa`.
[[nodiscard]] Recording grip_of(const GripWorld& world);

/// Largest command of a grip.
inline constexpr double grip_kpa = 40;

}  // namespace softgrip::sysid::health
