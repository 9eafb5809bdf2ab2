#pragma once
// Defines the reading of a channel. The drivers produce readings, and the controllers use them.

#include <cstdint>
#include <limits>

#include "base/time.h"

namespace softgrip::model {

/// Validity of a reading: the reason why the reading cannot be used, or `valid`.
enum class Validity : std::uint8_t {
  valid,
  none_yet,      ///< no reply so far
  out_of_range,  ///< outside the electrical range of the sensor
  sensor_error,  ///< an error code of the sensor or the board
  jumped,        ///< the reading changed faster than a finger can move
  frozen,        ///< the reading did not change while the command changed
  stale,         ///< older than the allowed age
};

/// The measured values of a channel.
struct Reading {
  double displacement_mm = 0;
  /// measured pressure if the channel has a pressure monitor, else NaN
  double pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  /// ambient temperature of the finger if the channel has a temperature sensor, else NaN
  double temperature_c = std::numeric_limits<double>::quiet_NaN();
  /// output that the board reports [kPa]; NaN if the board cannot report it
  double command_readback_kpa = std::numeric_limits<double>::quiet_NaN();
  Nanoseconds sampled_at = 0;  ///< time of the request to the board; 0 before the first reply
  std::uint32_t sequence = 0;  ///< number of replies so far
  Validity validity = Validity::none_yet;
};

}  // namespace softgrip::model
