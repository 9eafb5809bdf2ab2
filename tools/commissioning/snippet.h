#pragma once
// What a calibration leaves behind: lines for the rig file.

#include <optional>
#include <string>

#include "drivers/board/board_map.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools::calibrate {

/// How the finger was moved to its two places.
struct Motion {
  double low_kpa = 0;
  double high_kpa = 0;
  double wait_s = 0;           ///< at each, until the middle of the average
  double speed_kpa_per_s = 1;  ///< of the ramps to them, each from the rest pressure
};

struct Results {
  std::string date;  ///< "2026-11-20"
  std::size_t channel = 0;
  std::optional<Line> sensor;
  std::optional<ValveResult> valve;
  std::optional<DeadZoneResult> dead_zone;
  std::optional<Motion> motion;  ///< of the sensor's calibration, unless it was by hand
};

/// YAML: the maps `sensor`, `valve`, `pressure_monitor` of the channel as they should stand in the rig file,
/// with what was found as comments. Everything that was not calibrated keeps its values.
[[nodiscard]] std::string snippet(const rig::RigFile& rig, const Results& results);

/// A number as it stands in a rig file: to so many decimals, without zeros that say nothing.
[[nodiscard]] std::string rounded(double value, int decimals);
/// "v", "ma" or "kpa": the end of an electrical key.
[[nodiscard]] std::string suffix_of(drivers::ElectricalUnit unit);

/// Two points as they stand in a rig file.
struct PairText {
  std::string first;
  std::string second;
};
struct LineText {
  PairText at;
  PairText is;
};
[[nodiscard]] LineText text_of(const drivers::TwoPoints& points);

}  // namespace softgrip::tools::calibrate
