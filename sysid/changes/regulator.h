#pragma once
// Simulates the pressure regulator between command and finger. It is used if the pressure is not recorded.
// The model consists of a controller, ports and a tube.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Parameters of a regulator. A controller with a play and an integral moves a spool. The spool has a lag,
/// and it overlaps its ports. Air flows through a port into a chamber and from the chamber through the tube
/// into the volume of the finger. The flows follow ISO 6358-1 (choked or subsonic, linear near zero pressure
/// difference) at constant temperature.
struct Regulator {
  double play_kpa = 0.15;     ///< half the width of the range to which the controller does not respond
  double dead_kpa = 0.5;      ///< pressure error at which a port opens
  double full_kpa = 10;       ///< pressure error, in addition to dead_kpa, at which the port is fully open
  double integral_per_s = 2;  ///< gain of the controller for the integral of the error
  /// Conductance of a fully open port: pressure rise at choked flow in 1 s, as a share of the upstream
  /// pressure.
  double port_per_s = 5;
  double tube_per_s = 10;      ///< conductance of the tube, defined like port_per_s
  double spool_lag_s = 0.01;   ///< time constant of the spool
  double chamber_share = 0.2;  ///< volume between valve and tube, as a share of the volume of the finger
  /// Conductance of a leak from the finger to the atmosphere, defined like tube_per_s.
  double leak_per_s = 0;
};

/// Returns the rate at which a finger without inflow loses pressure [kPa/s] through a leak whose leak_per_s
/// is 1.
[[nodiscard]] double leaking_kpa_per_s(double gauge_kpa);

/// Returns the pressure at the finger [kPa] at each sample. The initial state is settled.
/// @param command_kpa  command at each sample of the record. If the supply is not recorded, four times the
/// largest command is assumed.
[[nodiscard]] std::vector<double> regulated(const Regulator& regulator, const Record& record,
                                            const std::vector<double>& command_kpa);

/// Returns the record with the regulated pressure as its drive.
[[nodiscard]] Record behind(const Regulator& regulator, const Record& record);

}  // namespace softgrip::sysid
