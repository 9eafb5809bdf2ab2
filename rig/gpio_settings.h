#pragma once
// The settings in the `gpio` map of a rig file: the digital lines and their functions.

#include <vector>

#include "document/problem.h"
#include "drivers/gpio/gpio_lines.h"

namespace softgrip::rig {

/// The map `gpio` of a rig file. rig/rig_keys.cpp declares the meaning and the range of each member.
struct GpioSettings {
  double debounce_s = 0;
  double stale_after_s = 0;
  double look_interval_s = 0.005;
  /// True: the enable output stays on while a fault is latched. An emergency stop, lost input lines and a
  /// stalled control loop switch it off in any case.
  bool keeps_enable_on_fault = false;
  std::vector<drivers::GpioLineSettings> lines;  ///< settings of the digital lines; at most one line for each
                                                 ///< purpose
  std::vector<document::Problem> places;  ///< location of each line in the rig file, stored as a problem
                                          ///< without a message

  [[nodiscard]] bool has(drivers::GpioRole role) const noexcept {
    for (const drivers::GpioLineSettings& line : lines) {
      if (line.role == role) return true;
    }
    return false;
  }
};

}  // namespace softgrip::rig
