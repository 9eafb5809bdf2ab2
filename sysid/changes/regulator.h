#pragma once
// Simulates a pressure regulator between a command and a finger if the pressure is not recorded: controller,
// ports and tube.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A controller with a play and an integral moves a spool, which has a lag and overlaps its ports. Air flows
/// through the port into a chamber and through the tube into the finger's volume by ISO 6358-1 (choked,
/// subsonic, linear near zero difference), at constant temperature.
struct Regulator {
  double play_kpa = 0.15;     ///< half the width of the controller's insensitive range
  double dead_kpa = 0.5;      ///< error at which a port opens
  double full_kpa = 10;       ///< additional error at which it is fully open
  double integral_per_s = 2;  ///< gain of the integral of the error
  double port_per_s = 5;  ///< choked and fully open: pressure rise in 1 s as a share of the upstream pressure
  double tube_per_s = 10;      ///< like port_per_s, for the tube
  double spool_lag_s = 0.01;   ///< lag behind the command of the controller
  double chamber_share = 0.2;  ///< volume of the valve before the tube, as a share of the finger's volume
  double leak_per_s = 0;       ///< like tube_per_s, from the finger to the atmosphere
};

/// Returns the pressure that a finger loses through a leak of 1 per second without inflow [kPa/s].
[[nodiscard]] double leaking_kpa_per_s(double gauge_kpa);

/// Returns the pressure at the finger [kPa] at each sample. It is settled at the start.
/// @param command_kpa  as long as the record. A supply that is not recorded counts as four times the largest
/// command.
[[nodiscard]] std::vector<double> regulated(const Regulator& regulator, const Record& record,
                                            const std::vector<double>& command_kpa);

/// Returns the record with the regulated pressure as its drive.
[[nodiscard]] Record behind(const Regulator& regulator, const Record& record);

}  // namespace softgrip::sysid
