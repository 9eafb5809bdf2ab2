#pragma once
// What really happened, as the emulator knows it: a log with a `channel` column and true values.
//
//   time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reading_mm,object,watchdog_tripped
//
// displacement_mm and pressure_kpa are without noise; reading_mm is what the sensor showed (empty: nothing).

#include <cstdint>
#include <fstream>
#include <string>

#include "simulation/emulator/emulator.h"

namespace softgrip::simulation {

class TruthLog {
 public:
  /// One row per channel every `decimation` calls of add().
  TruthLog(const std::string& path, std::uint32_t decimation);

  void add(const Emulator& emulator);
  /// Hands all rows to the system.
  void flush() { file_.flush(); }
  /// False once something could not be written.
  [[nodiscard]] bool good() const { return file_.good(); }

 private:
  std::ofstream file_;
  std::string row_;
  std::uint32_t decimation_;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::simulation
