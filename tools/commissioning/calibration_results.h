#pragma once
// The results of a calibration: their lines for the rig file, their plausibility, and the update of the rig
// file.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

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
  std::string date;  ///< date of the calibration in the form "2026-11-20"
  std::size_t channel = 0;
  std::optional<Line> sensor;
  std::optional<ValveResult> valve;
  std::optional<DeadZoneResult> dead_zone;
  std::optional<Motion> motion;  ///< motion of the finger during the calibration of the sensor; nullopt: a
                                 ///< person moved the target
};

/// Returns YAML lines for the rig file: those of the maps `sensor`, `valve` and `pressure_monitor` of the
/// channel that were calibrated, with the results of the calibration as comments. A value that was not
/// calibrated is copied from the rig file.
[[nodiscard]] std::string snippet(const rig::RigFile& rig, const Results& results);

/// Formats a number for a rig file: rounded to `decimals`, without trailing zeros.
[[nodiscard]] std::string rounded(double value, int decimals);

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

/// Largest deviation that causes no warning. It is a share of the range between the limits, or of the motion
/// that the model predicts.
inline constexpr double most_share_off = 0.2;

/// Compares each calibrated line with the line in the rig file. Returns one warning for each line whose
/// deviation exceeds `most_share_off`. Also warns if the motion of the finger between the two pressures
/// deviates by more than this share from the motion of its model. The list is empty if there is no warning.
[[nodiscard]] std::vector<std::string> plausibility_warnings(const rig::RigFile& rig, const Results& results);

/// Returns the text of the rig file with the new points of the calibrated maps. All other lines, including
/// comments, stay unchanged. A comment above each map states the date and the error of the calibration. In a
/// rig with several channels, `channel_defaults` is not changed: the new points are added to the channel. The
/// rig-file reader has accepted the new text. The error is a sentence that says why a person must insert the
/// lines.
[[nodiscard]] tl::expected<std::string, std::string> updated_rig(const std::string& text,
                                                                 const rig::RigFile& rig,
                                                                 const Results& results);

/// Writes `text` to the file from which `rig` was read, and keeps a copy of the old file in the same folder.
/// Returns the path of the copy. If the file has changed since it was read, or if a step fails, the rig file
/// stays unchanged.
[[nodiscard]] tl::expected<std::string, std::string> write_rig(const rig::RigFile& rig,
                                                               const std::string& text);

}  // namespace softgrip::tools::calibrate
