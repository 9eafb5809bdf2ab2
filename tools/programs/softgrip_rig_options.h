#pragma once
// The options of softgrip-rig, and the settings of the emulator that these options determine.

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
  std::vector<std::string> models;  ///< paths of the model files: one file for all channels, or one file per
                                    ///< channel
  std::vector<std::string> boards{"adam-6024"};  ///< board file of each module: a path, or the name of a file
                                                 ///< in config/boards
  std::string rig;                               ///< rig file with the wiring; empty: default wiring
  std::size_t channels = 2;                      ///< number of channels if there is no rig file
  std::optional<std::uint8_t> unit;  ///< unit id of the first module; the id of each next module is larger by
                                     ///< 1
  std::string bind = "127.0.0.1";
  bool allow_network = false;
  std::optional<std::uint16_t> port;  ///< TCP port; nullopt: the port of the rig file, or 1502 without a rig
                                      ///< file
  std::string rtu;  ///< path of the serial device that is used instead of the network; empty: the network is
                    ///< used
  bool rtu_over_tcp = false;          ///< true: the emulator sends RTU frames over TCP
  std::optional<std::uint32_t> baud;  ///< baud rate [Bd]; nullopt: the value of the rig file, or 9600 (8N1)
                                      ///< without a rig file
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
  std::optional<drivers::SerialLine> line;  ///< serial line that is used instead of the network; nullopt: the
                                            ///< network is used
};

/// Creates the setup from the options. On failure, prints all problems and returns the exit code.
[[nodiscard]] tl::expected<Setup, ExitCode> make_setup(const Options& options);

}  // namespace softgrip::tools
