#pragma once
// The `gpio` map of a rig file: which digital lines there are and what they mean.

#include <vector>

#include "document/problem.h"
#include "drivers/gpio/gpio_lines.h"

namespace softgrip::rig {

struct GpioSettings {
  /// An input counts as changed when it has been steady for so long [s].
  double debounce_s = 0;
  /// The lines count as lost, and the loop as hung, when nothing was heard of them for so long [s].
  double stale_after_s = 0;
  /// Longest pause between two looks at the levels [s]: what a lost edge can cost.
  double look_interval_s = 0.005;
  /// What the enable output does while a fault other than the emergency stop is latched.
  bool enable_drops_on_fault = true;
  std::vector<drivers::GpioLineSettings> lines;  ///< at most one per role
  std::vector<document::Problem> places;         ///< of each line in the rig file, without a message

  [[nodiscard]] bool has(drivers::GpioRole role) const noexcept {
    for (const drivers::GpioLineSettings& line : lines) {
      if (line.role == role) return true;
    }
    return false;
  }
};

}  // namespace softgrip::rig
