#pragma once
// Simulates the pressure regulator between command and finger, and estimates its parameters from records. The
// simulation is used if the pressure is not recorded. The regulator consists of a controller, ports and a
// tube.

#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Parameters of a regulator. A controller with a play and an integral term moves a spool. The spool responds
/// with a lag and overlaps its ports. Air flows through a port into a chamber, and from the chamber through a
/// tube into the finger. The flows follow ISO 6358-1 (choked or subsonic, linear near zero pressure
/// difference) at constant temperature.
struct Regulator {
  double play_kpa = 0.15;     ///< half the width of the band in which the controller does not respond to the
                              ///< command
  double dead_kpa = 0.5;      ///< pressure error at which a port opens
  double full_kpa = 10;       ///< additional pressure error above dead_kpa at which the port is fully open
  double integral_per_s = 2;  ///< gain of the controller for the integral of the error
  /// Conductance of a fully open port: pressure rise per second at choked flow, as a share of the upstream
  /// pressure.
  double port_per_s = 5;
  double tube_per_s = 10;      ///< conductance of the tube, with the same definition as port_per_s
  double spool_lag_s = 0.01;   ///< time constant of the spool
  double chamber_share = 0.2;  ///< volume between valve and tube, as a share of the volume of the finger
  /// Conductance of a leak from the finger to the atmosphere, with the same definition as port_per_s.
  double leak_per_s = 0;
};

/// Returns the pressure loss per second of a finger without inflow [kPa/s]. The leak has a leak_per_s of 1.
[[nodiscard]] double leaking_kpa_per_s(double gauge_kpa);

/// Returns the pressure at the finger [kPa] at each sample. The regulator is at equilibrium at the first
/// sample.
/// @param command_kpa  command at each sample of the record. If the supply pressure is not recorded, it is
/// assumed to be four times the largest command.
[[nodiscard]] std::vector<double> regulated(const Regulator& regulator, const Record& record,
                                            const std::vector<double>& command_kpa);

/// Returns the record with the pressure at the output of the regulator as its drive.
[[nodiscard]] Record behind(const Regulator& regulator, const Record& record);

/// Quantity that was recorded behind a regulator.
enum class ReadBy {
  gauge,  ///< the pressure; gain and zero offset of its sensor are fitted
  /// The displacement. It is described by a bank of plays and lags, whose weights are fitted for each
  /// regulator.
  finger,
};

/// Returns the regulator with the smallest sum of squared residuals.
/// @param records  records whose drive is the command.
[[nodiscard]] Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa,
                                      ReadBy read_by = ReadBy::finger);

}  // namespace softgrip::sysid
