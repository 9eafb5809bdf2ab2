#pragma once
// What the user of softgrip-rig asked for, and the emulator that it makes.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "drivers/modbus/modbus_address.h"
#include "simulation/emulator/emulator.h"

namespace softgrip::tools {

struct Options {
  std::vector<std::string> models;               ///< one for all channels, or one per channel
  std::vector<std::string> boards{"adam-6024"};  ///< files, or names in config/boards: one per module
  std::string rig;                   ///< rig file that says what is wired where; empty: default wiring
  std::size_t channels = 2;          ///< without a rig file
  std::optional<std::uint8_t> unit;  ///< of the first module; the others count on
  std::string bind = "127.0.0.1";
  bool allow_network = false;
  std::optional<std::uint16_t> port;  ///< default: the rig file's, or 1502
  std::string rtu;                    ///< serial device in the place of the network
  bool rtu_over_tcp = false;          ///< RTU frames on the network
  std::optional<std::uint32_t> baud;  ///< of the line; these default to the rig file's, or 9600 8N1
  std::optional<std::string> format;
  std::optional<double> turnaround_s;
  std::string object;
  std::optional<double> object_out_at_s;
  std::string faults;
  std::string truth;
  double truth_rate_hz = 1000;
  std::optional<double> watchdog_s;  ///< in place of the board map's timeout; 0: no watchdog
  double noise_mm = 0.03;
  double pressure_noise_kpa = 0.1;
  std::uint64_t seed = 1;
  std::string control;  ///< path of a socket, "-" the standard input
};

/// What the program runs.
struct Setup {
  simulation::EmulatorSettings emulator;
  std::vector<drivers::TcpAddress> addresses;  ///< to listen on, one per link
  std::optional<drivers::SerialLine> line;     ///< in the place of the network
};

/// The error is an exit code: all problems have been printed.
[[nodiscard]] tl::expected<Setup, ExitCode> make_setup(const Options& options);

}  // namespace softgrip::tools
