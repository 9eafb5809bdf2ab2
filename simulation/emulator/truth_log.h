#pragma once
// Writes the true state of the emulated rig to a log. The log has a row per channel, with the name of the
// channel in the column `channel`:
//
//   time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reading_mm,object,watchdog_tripped
//
// displacement_mm and pressure_kpa are true values without noise. reading_mm is the sensor reading; its cell
// is empty if there is no valid reading.

#include <cstdint>
#include <fstream>
#include <string>

#include "simulation/emulator/emulator.h"

namespace softgrip::simulation {

class TruthLog {
 public:
  /// Creates the log file. Only every `decimation`-th call of add() writes rows: one row per channel.
  TruthLog(const std::string& path, std::uint32_t decimation);

  void add(const Emulator& emulator);
  /// Writes all rows in the buffer to the file.
  void flush() { file_.flush(); }
  /// Returns false if a write has failed.
  [[nodiscard]] bool good() const { return file_.good(); }

 private:
  std::ofstream file_;
  std::string row_;
  std::uint32_t decimation_;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::simulation
