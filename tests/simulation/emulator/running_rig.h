#pragma once
// Runs the emulator in a thread of the test. The emulator uses free ports or a pseudo-terminal. This header
// also provides the board settings with which a driver connects to the emulator.

#include <string>
#include <thread>
#include <vector>

#include "drivers/modbus/modbus_board.h"
#include "simulation/emulator/server.h"

namespace softgrip::simulation::test {

struct RunningRigSettings {
  std::vector<drivers::BoardMap> maps;  ///< board map of each module
  std::vector<std::string> names;       ///< names of the modules
  Wire wire = Wire::tcp;                ///< type of connection; on a network, every module has its own
                                        ///< address
  drivers::SerialLine line;             ///< settings of a serial line; RunningRig creates its pseudo-terminal
  std::size_t channels = 2;
  std::vector<FaultSpec> habits{};  ///< unusual behaviour of the board, active from the start
  bool rtu_over_tcp = false;        ///< true: the network connection uses RTU frames
};

/// An emulated rig with fingers of the model bench_twin without noise. default_wiring() determines the
/// wiring. On a serial line, the modules have the unit addresses 1, 2, ...
class RunningRig {
 public:
  explicit RunningRig(const RunningRigSettings& settings);
  RunningRig(const RunningRig&) = delete;
  RunningRig& operator=(const RunningRig&) = delete;
  RunningRig(RunningRig&&) = delete;
  RunningRig& operator=(RunningRig&&) = delete;
  ~RunningRig();

  /// Returns the settings with which a driver connects to the emulator.
  [[nodiscard]] const drivers::ModbusSettings& board() const noexcept { return board_; }
  /// Stops the emulator and returns it. A test must not read the state of the emulator before this call.
  const Emulator& stop();

 private:
  drivers::ModbusSettings board_;
  std::unique_ptr<Emulator> emulator_;
  Descriptor stop_;
  std::thread thread_;
};

}  // namespace softgrip::simulation::test
