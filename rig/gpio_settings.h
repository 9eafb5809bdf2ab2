#pragma once
// The `gpio` map of a rig file: the digital lines and their functions.

#include <vector>

#include "document/problem.h"
#include "drivers/gpio/gpio_lines.h"

namespace softgrip::rig {

struct GpioSettings {
  /// An input counts as changed after it has been steady for this time [s].
  double debounce_s = 0;
  /// Time without a message from the lines or the loop after which the lines count as lost, or the loop as
  /// stalled [s].
  double stale_after_s = 0;
  /// Longest interval between two reads of the levels [s]. If an edge is missed, the new level is detected
  /// within this time.
  double look_interval_s = 0.005;
  /// The enable output is switched off while a fault other than the emergency stop is latched.
  bool enable_drops_on_fault = true;
  std::vector<drivers::GpioLineSettings> lines;  ///< at most one per role
  std::vector<document::Problem> places;         ///< place of each line in the rig file, without a message

  [[nodiscard]] bool has(drivers::GpioRole role) const noexcept {
    for (const drivers::GpioLineSettings& line : lines) {
      if (line.role == role) return true;
    }
    return false;
  }
};

}  // namespace softgrip::rig
