#pragma once
// Formats the results of a calibration as lines for the rig file.

#include <optional>
#include <string>

#include "drivers/board/board_map.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools::calibrate {

/// The motion of the finger to the two positions of a calibration.
struct Motion {
  double low_kpa = 0;
  double high_kpa = 0;
  double wait_s = 0;           ///< time from the end of the ramp to the middle of the averaging interval [s]
  double speed_kpa_per_s = 1;  ///< speed of the ramps, each of which begins at the rest pressure [kPa/s]
};

struct Results {
  std::string date;  ///< date of the calibration, for example "2026-11-20"
  std::size_t channel = 0;
  std::optional<Line> sensor;
  std::optional<ValveResult> valve;
  std::optional<DeadZoneResult> dead_zone;
  std::optional<Motion> motion;  ///< motion during the calibration of the sensor; nullopt: a person moved the
                                 ///< target
};

/// Returns YAML lines for the rig file: the maps `sensor`, `valve` and `pressure_monitor` of the channel,
/// with the findings as comments. A value that was not calibrated is copied from the rig file.
[[nodiscard]] std::string snippet(const rig::RigFile& rig, const Results& results);

/// Formats a number for a rig file: rounded to `decimals`, without trailing zeros.
[[nodiscard]] std::string rounded(double value, int decimals);
/// Returns the end of a key that contains electrical values: "v", "ma" or "kpa".
[[nodiscard]] std::string suffix_of(drivers::ElectricalUnit unit);

/// The x and y values of two points as texts for a rig file.
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
