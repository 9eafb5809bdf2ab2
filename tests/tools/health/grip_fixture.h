#pragma once
// A grip as the daemon records it: rest, up to the touch, held, let go, vented. Without the daemon.

#include <cstdint>

#include "tools/recordings/recording.h"

namespace softgrip::tools::health {

/// What became of the finger, its line and its sensor.
struct GripWorld {
  double gain = 1;
  double zero_mm = 0;
  double lag_s = 0;
  double extra_creep_mm = 0;  ///< farther, at the end of the last second of a run
  double loop_mm = 0;         ///< higher on the way back
  double loss_kpa = 0;
  double leak_kpa_per_s = 0;
  double object_mm = 12;  ///< infinite: nothing there
  double rise_s = 3;      ///< to the touch and on
  double noise_mm = 0.02;
  bool measures_pressure = true;
  std::uint64_t seed = 1;
};

/// One channel, `left`, 100 Hz; commands in kPa up to `grip_kpa`.
[[nodiscard]] Recording grip_of(const GripWorld& world);

/// Largest command of a grip.
inline constexpr double grip_kpa = 40;

}  // namespace softgrip::tools::health
