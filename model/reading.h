#pragma once
// Defines the reading of a channel. The drivers produce readings, and the controller uses them.

#include <cstdint>
#include <limits>

#include "base/time.h"

namespace softgrip::model {

/// The validity of a reading: `valid`, or the reason why the reading cannot be used.
enum class Validity : std::uint8_t {
  valid,
  none_yet,      ///< the board has not sent a first reply yet
  out_of_range,  ///< the signal is outside the electrical range of the sensor
  sensor_error,  ///< the sensor or the board reported an error code
  jumped,        ///< the reading changed faster than a finger can move
  frozen,        ///< the reading stayed constant while the command changed
  stale,         ///< the reading is older than max_age_s
};

/// The measured values of a channel.
struct Reading {
  double displacement_mm = 0;
  /// Measured pressure [kPa]; NaN if the channel has no pressure monitor.
  double pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  /// Ambient temperature of the finger [degC]; NaN if the channel has no temperature sensor.
  double temperature_c = std::numeric_limits<double>::quiet_NaN();
  /// Output pressure that the board reports [kPa]; NaN if the board does not report its outputs.
  double command_readback_kpa = std::numeric_limits<double>::quiet_NaN();
  Nanoseconds sampled_at = 0;  ///< time at which the request for this reading was sent to the board; 0 before
                               ///< the first reply
  std::uint32_t sequence = 0;  ///< number of replies that the board has sent so far
  Validity validity = Validity::none_yet;
};

}  // namespace softgrip::model
