#pragma once
// The emulator in a thread of the test, on free ports or on a pseudo-terminal, and the board that talks to
// it.

#include <string>
#include <thread>
#include <vector>

#include "drivers/modbus/modbus_board.h"
#include "simulation/emulator/server.h"

namespace softgrip::simulation::test {

struct RunningRigSettings {
  std::vector<drivers::BoardMap> maps;  ///< one per module
  std::vector<std::string> names;       ///< of the modules
  Wire wire = Wire::tcp;                ///< on a network every module is a host of its own
  drivers::SerialLine line;             ///< of a serial line; the device is made up
  std::size_t channels = 2;
  std::vector<FaultSpec> habits{};  ///< faults that are there from the start
  bool rtu_over_tcp = false;        ///< on a network: RTU frames
};

/// Fingers of the bench twin without noise, as default_wiring() wires them. On a serial line the modules have
/// the units 1, 2, ...
class RunningRig {
 public:
  explicit RunningRig(const RunningRigSettings& settings);
  RunningRig(const RunningRig&) = delete;
  RunningRig& operator=(const RunningRig&) = delete;
  RunningRig(RunningRig&&) = delete;
  RunningRig& operator=(RunningRig&&) = delete;
  ~RunningRig();

  /// What leads to it.
  [[nodiscard]] const drivers::ModbusSettings& board() const noexcept { return board_; }
  /// Ends the emulator; only then may it be looked at.
  const Emulator& stop();

 private:
  drivers::ModbusSettings board_;
  std::unique_ptr<Emulator> emulator_;
  Descriptor stop_;
  std::thread thread_;
};

}  // namespace softgrip::simulation::test
