#pragma once
// Options of softgrip-rig and the emulator settings that follow from these options.

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
  std::vector<std::string> models;               ///< model files: one for all channels, or one per channel
  std::vector<std::string> boards{"adam-6024"};  ///< board of each module: a file, or a name in config/boards
  std::string rig;                               ///< rig file with the wiring; empty: default wiring
  std::size_t channels = 2;                      ///< number of channels if there is no rig file
  std::optional<std::uint8_t> unit;              ///< unit id of the first module; each further module has the
                                                 ///< next id
  std::string bind = "127.0.0.1";
  bool allow_network = false;
  std::optional<std::uint16_t> port;  ///< TCP port; default: the port of the rig file; without a rig file,
                                      ///< 1502
  std::string rtu;                    ///< serial device that is used instead of the network
  bool rtu_over_tcp = false;          ///< true: the emulator sends RTU frames over TCP
  std::optional<std::uint32_t> baud;  ///< baud rate; default: the value of the rig file; without a rig file,
                                      ///< 9600 8N1
  std::optional<std::string> format;
  std::optional<double> turnaround_s;
  std::string object;
  std::optional<double> object_out_at_s;
  std::string faults;
  std::string truth;
  double truth_rate_hz = 1000;
  std::optional<double> watchdog_s;  ///< watchdog time that replaces the time in the board file [s]; 0: no
                                     ///< watchdog
  double noise_mm = 0.03;
  double pressure_noise_kpa = 0.1;
  std::uint64_t seed = 1;
  std::string control;  ///< path of the Unix socket for commands to the emulator; "-": the standard input
};

/// The settings of the emulator, and the addresses or the serial line on which the emulator responds.
struct Setup {
  simulation::EmulatorSettings emulator;
  std::vector<drivers::TcpAddress> addresses;  ///< listening addresses of the emulator, one per link
  std::optional<drivers::SerialLine> line;     ///< if set, the serial line that is used instead of the
                                               ///< network
};

/// Creates the setup. On failure, prints all problems and returns the exit code.
[[nodiscard]] tl::expected<Setup, ExitCode> make_setup(const Options& options);

}  // namespace softgrip::tools
