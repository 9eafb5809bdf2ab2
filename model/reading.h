#pragma once
// What comes back from a channel. Drivers make readings, control uses them.

#include <cstdint>
#include <limits>

#include "base/time.h"

namespace softgrip::model {

/// Why a reading can or cannot be used. The first reason that holds.
enum class Validity : std::uint8_t {
  valid,
  none_yet,      ///< no reply so far
  out_of_range,  ///< outside the electrical range of the sensor
  sensor_error,  ///< one of the sensor's or board's error codes
  jumped,        ///< moved faster than the finger can
  frozen,        ///< did not change while the command moved
  stale,         ///< older than the allowed age
};

/// What came back from a channel.
struct Reading {
  double displacement_mm = 0;
  /// measured, if the channel has a monitor input; else NaN
  double pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  /// of the finger's surroundings, if the channel has a temperature sensor; else NaN
  double temperature_c = std::numeric_limits<double>::quiet_NaN();
  /// what the board says it outputs, if it can be read back; else NaN
  double command_readback_kpa = std::numeric_limits<double>::quiet_NaN();
  Nanoseconds sampled_at = 0;  ///< when the board was asked; 0 before the first reply
  std::uint32_t sequence = 0;  ///< counts the replies
  Validity validity = Validity::none_yet;
};

}  // namespace softgrip::model
