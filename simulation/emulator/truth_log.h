#pragma once
// Writes the true state of the emulated rig: a log with a `channel` column and true values.
//
//   time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reading_mm,object,watchdog_tripped
//
// displacement_mm and pressure_kpa are true values without noise. reading_mm is the sensor reading; it is
// empty if there is no valid reading.

#include <cstdint>
#include <fstream>
#include <string>

#include "simulation/emulator/emulator.h"

namespace softgrip::simulation {

class TruthLog {
 public:
  /// Creates the file. Every `decimation`-th call of add() writes one row per channel.
  TruthLog(const std::string& path, std::uint32_t decimation);

  void add(const Emulator& emulator);
  /// Writes all buffered rows to the file.
  void flush() { file_.flush(); }
  /// Returns false after a write has failed.
  [[nodiscard]] bool good() const { return file_.good(); }

 private:
  std::ofstream file_;
  std::string row_;
  std::uint32_t decimation_;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::simulation
