#pragma once
// Reads and writes gauge files: readings of a displacement sensor at positions that gauge blocks or a dial
// gauge define.
//
//   gauge_mm,displacement_mm[,samples][,...]
//
// For a bending angle the columns are gauge_deg and angle_deg, or gauge_rad and angle_rad. Radians are
// converted to degrees. Each row contains one reading, and the rows are in the order in which the readings
// were taken. Positions may occur repeatedly and in any order. `samples` is the number of sensor samples that
// were averaged for the reading (1 without this column). Other columns are ignored.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "model/output_unit.h"

namespace softgrip::sysid {

struct GaugeReading {
  double position_mm = 0;  ///< position that the gauge shows; the zero of the gauge is arbitrary
  double reading_mm = 0;   ///< reading of the sensor
  double samples = 1;      ///< number of sensor samples that were averaged for the reading, at least 1

  bool operator==(const GaugeReading&) const = default;
};

struct GaugeFile {
  std::string path;    ///< path of the file as the user has written it
  std::string sha256;  ///< SHA-256 of the bytes of the file, in lower-case hexadecimal
  std::vector<GaugeReading> readings;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of `position_mm` and `reading_mm`
};

/// Smallest number of different positions in a gauge file. Any 2 positions fit a straight line exactly, so at
/// least 3 are necessary.
inline constexpr std::size_t fewest_gauge_positions = 3;

/// Parses the text of a gauge file. Adds each problem to `problems`; if there is a problem, returns nullopt.
/// `file` is the file name for the messages.
[[nodiscard]] std::optional<GaugeFile> parse_gauge(const std::string& file, std::string_view text,
                                                   document::Problems& problems);

/// Reads and parses a gauge file. Adds a problem if the file cannot be read.
[[nodiscard]] std::optional<GaugeFile> read_gauge(const std::string& path, document::Problems& problems);

/// Returns the readings as CSV text, from which parse_gauge() returns the same readings.
[[nodiscard]] std::string format_gauge(const std::vector<GaugeReading>& readings,
                                       model::OutputUnit output_unit = model::OutputUnit::mm);

/// Sorts a list of positions and removes repeated positions.
[[nodiscard]] std::vector<double> distinct_positions(std::vector<double> positions_mm);
/// Returns the positions of the readings in increasing order, without repetitions.
[[nodiscard]] std::vector<double> distinct_positions(const std::vector<GaugeReading>& readings);

/// Returns the positions of a proposed gauge check. The check has at least nine positions in equal round
/// steps from 0 to about 1.3 times the largest reading of the logs. This range is large enough to show a
/// saturation of the sensor. The list contains the positions three times: in increasing, decreasing and again
/// increasing order.
[[nodiscard]] std::vector<double> planned_positions(double largest_reading_mm);

/// Returns a gauge file as a template for the user: the positions with empty readings.
[[nodiscard]] std::string positions_csv(const std::vector<double>& positions_mm,
                                        model::OutputUnit output_unit = model::OutputUnit::mm);

/// Assumed time for one gauge reading [s]: move to the position, wait until the sensor is at rest, read the
/// sensor.
inline constexpr double seconds_per_reading = 20;
[[nodiscard]] inline double minutes_for(std::size_t readings) {
  return seconds_per_reading * static_cast<double>(readings) / 60;
}

}  // namespace softgrip::sysid
