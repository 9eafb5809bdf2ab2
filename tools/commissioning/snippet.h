#pragma once
// What a calibration leaves behind: lines for the rig file.

#include <optional>
#include <string>

#include "tools/commissioning/procedure.h"

namespace softgrip::tools::calibrate {

struct Results {
  std::string date;  ///< "2026-11-20"
  std::size_t channel = 0;
  std::optional<Line> sensor;
  std::optional<ValveResult> valve;
  std::optional<DeadZoneResult> dead_zone;
};

/// YAML: the maps `sensor`, `valve`, `pressure_monitor` of the channel as they should stand in the rig file,
/// with what was found as comments. Everything that was not calibrated keeps its values.
[[nodiscard]] std::string snippet(const rig::RigFile& rig, const Results& results);

}  // namespace softgrip::tools::calibrate
