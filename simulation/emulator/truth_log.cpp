#include "simulation/emulator/truth_log.h"

#include <algorithm>

#include "base/numbers.h"

namespace softgrip::simulation {

TruthLog::TruthLog(const std::string& path, std::uint32_t decimation)
    : file_(path, std::ios::trunc), decimation_(std::max(decimation, 1U)) {
  file_ << "time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reading_mm,object,watchdog_"
           "tripped\n";
}

void TruthLog::add(const Emulator& emulator) {
  if (count_++ % decimation_ != 0) return;
  // The times are rounded to microseconds to keep their text in the log short.
  const std::int64_t time_us = emulator.now() / 1000;
  const double time_s = static_cast<double>(time_us) / 1e6;
  for (const Finger& finger : emulator.fingers()) {
    const simulation::Plant& plant = finger.plant();
    row_ = shortest(time_s) + "," + finger.name();
    for (const double value : {plant.held_command_kpa(), plant.displacement_mm(), plant.pressure_kpa()}) {
      row_ += "," + shortest(value);
    }
    row_ += ",";
    if (!plant.sees_nothing()) row_ += shortest(plant.reading_mm());
    row_ += finger.has_object() ? ",1" : ",0";
    row_ += emulator.tripped() ? ",1\n" : ",0\n";
    file_ << row_;
  }
}

}  // namespace softgrip::simulation
