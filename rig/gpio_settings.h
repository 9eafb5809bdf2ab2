#pragma once
// The settings in the `gpio` map of a rig file: the digital lines and their functions.

#include <vector>

#include "document/problem.h"
#include "drivers/gpio/gpio_lines.h"

namespace softgrip::rig {

struct GpioSettings {
  /// An input counts as changed after its new level has been steady for this time [s].
  double debounce_s = 0;
  /// If no read of the lines succeeds for this time, the lines count as lost. If the loop executes no tick
  /// for this time, the loop counts as stalled [s].
  double stale_after_s = 0;
  /// Longest time between two reads of the levels [s]. If an edge is missed, the new level is detected within
  /// this time.
  double look_interval_s = 0.005;
  /// True: the enable output is switched off while a fault is latched. An emergency stop switches it off in
  /// any case.
  bool enable_drops_on_fault = true;
  std::vector<drivers::GpioLineSettings> lines;  ///< settings of the lines; at most one line for each purpose
  std::vector<document::Problem> places;         ///< for each line, its location in the rig file, as a
                                                 ///< problem without a message

  [[nodiscard]] bool has(drivers::GpioRole role) const noexcept {
    for (const drivers::GpioLineSettings& line : lines) {
      if (line.role == role) return true;
    }
    return false;
  }
};

}  // namespace softgrip::rig
