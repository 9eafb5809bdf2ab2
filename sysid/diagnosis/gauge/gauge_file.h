#pragma once
// What a displacement sensor reads where a gauge knows the position: blocks of known length, a dial gauge.
//
//   gauge_mm,displacement_mm[,samples][,...]
//
// One row per reading, in the order in which they were taken; positions may come again and need not rise.
// `samples`: how many of the sensor's samples a reading is the mean of (1 without the column). Other columns
// are ignored.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"

namespace softgrip::sysid {

struct GaugeReading {
  double position_mm = 0;  ///< true, by the gauge; its zero may be anywhere
  double reading_mm = 0;   ///< of the sensor
  double samples = 1;      ///< that the reading is the mean of, at least 1

  bool operator==(const GaugeReading&) const = default;
};

struct GaugeFile {
  std::string path;    ///< as the user named it
  std::string sha256;  ///< of its bytes, lower-case hexadecimal
  std::vector<GaugeReading> readings;
};

/// Two positions make a straight line of everything.
inline constexpr std::size_t fewest_gauge_positions = 3;

/// All problems are added to `problems`; with one there is no file. `file` names it in messages.
[[nodiscard]] std::optional<GaugeFile> parse_gauge(const std::string& file, std::string_view text,
                                                   document::Problems& problems);

/// The same from a file. A file that cannot be read is a problem too.
[[nodiscard]] std::optional<GaugeFile> read_gauge(const std::string& path, document::Problems& problems);

/// The CSV text; parse_gauge() of it gives the same readings.
[[nodiscard]] std::string format_gauge(const std::vector<GaugeReading>& readings);

/// The different ones, rising.
[[nodiscard]] std::vector<double> distinct_positions(std::vector<double> positions_mm);
/// Those of readings.
[[nodiscard]] std::vector<double> distinct_positions(const std::vector<GaugeReading>& readings);

/// Where to read: from 0 to about 1.3 times the largest reading of the logs, so that an end of the sensor
/// shows; at least nine positions in round steps, up, down and up again.
[[nodiscard]] std::vector<double> planned_positions(double largest_reading_mm);

/// A gauge file without readings yet, to be filled in.
[[nodiscard]] std::string positions_csv(const std::vector<double>& positions_mm);

/// What a reading costs: placing the target, letting it rest, reading.
inline constexpr double seconds_per_reading = 20;
[[nodiscard]] inline double minutes_for(std::size_t readings) {
  return seconds_per_reading * static_cast<double>(readings) / 60;
}

}  // namespace softgrip::sysid
