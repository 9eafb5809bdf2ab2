#pragma once
// Formats the results of a calibration as lines for the rig file.

#include <optional>
#include <string>

#include "drivers/board/board_map.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools::calibrate {

/// The motion of the finger to its two positions.
struct Motion {
  double low_kpa = 0;
  double high_kpa = 0;
  double wait_s = 0;           ///< time from the end of the ramp to the middle of the averaging interval
  double speed_kpa_per_s = 1;  ///< speed of the ramps, each of which begins at the rest pressure
};

struct Results {
  std::string date;  ///< "2026-11-20"
  std::size_t channel = 0;
  std::optional<Line> sensor;
  std::optional<ValveResult> valve;
  std::optional<DeadZoneResult> dead_zone;
  std::optional<Motion> motion;  ///< motion that calibrated the sensor; nullopt: the target was moved by hand
};

/// Returns YAML with the maps `sensor`, `valve` and `pressure_monitor` of the channel for the rig file, and
/// the findings as comments. Values that were not calibrated stay unchanged.
[[nodiscard]] std::string snippet(const rig::RigFile& rig, const Results& results);

/// Formats a number for a rig file: rounded to `decimals`, without trailing zeros.
[[nodiscard]] std::string rounded(double value, int decimals);
/// "v", "ma" or "kpa": the end of an electrical key.
[[nodiscard]] std::string suffix_of(drivers::ElectricalUnit unit);

/// The texts of two points for a rig file.
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
