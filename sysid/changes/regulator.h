#pragma once
// A pressure regulator between a command and a finger: what its controller, its ports and its tube do to the
// pressure, where that is not recorded.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A controller with a play and an integral moves a spool, which lags and overlaps its ports; air flows
/// through the port into a chamber and through the tube into the finger's volume by ISO 6358-1 (choked,
/// subsonic, linear next to no difference), at one temperature.
struct Regulator {
  double play_kpa = 0.15;      ///< half the width of what the controller does not see
  double dead_kpa = 0.5;       ///< error from which on a port opens
  double full_kpa = 10;        ///< and by how much more it is fully open
  double integral_per_s = 2;   ///< of the error
  double port_per_s = 5;       ///< choked, fully open: by what share of the pressure before it a second fills
  double tube_per_s = 10;      ///< likewise
  double spool_lag_s = 0.01;   ///< behind the command of the controller
  double chamber_share = 0.2;  ///< of the finger's volume: the valve's before the tube
  double leak_per_s = 0;       ///< as tube_per_s, from the finger into the open
};

/// Pressure that a finger loses through a leak of 1 per second [kPa/s], without inflow.
[[nodiscard]] double leaking_kpa_per_s(double gauge_kpa);

/// The pressure at the finger [kPa], sample by sample; it begins settled.
/// @param command_kpa  as long as the record. A supply that is not recorded counts as four times the largest
/// command.
[[nodiscard]] std::vector<double> regulated(const Regulator& regulator, const Record& record,
                                            const std::vector<double>& command_kpa);

/// The record as the finger sees it.
[[nodiscard]] Record behind(const Regulator& regulator, const Record& record);

}  // namespace softgrip::sysid
