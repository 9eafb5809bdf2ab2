#pragma once
// From what was measured at two places to a straight line, or to the reason why there is none.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/two_points.h"

namespace softgrip::tools::calibrate {

/// One visit to one of the two places.
struct Visit {
  bool upper = false;     ///< of the two places, the one with the larger command or the second by hand
  double electrical = 0;  ///< mean [V or mA]
  double noise = 0;       ///< standard deviation of one electrical reading
  double drift = 0;       ///< how much the mean moved from the first to the second half of the visit
  std::size_t count = 0;  ///< readings in the mean
  double reference = 0;   ///< what gauge or manometer showed [mm or kPa]
};

/// Below these a calibration is refused.
struct Demands {
  double least_span = 0;             ///< of the references [mm or kPa]
  double least_electrical_span = 0;  ///< [V or mA]
  double most_noise_share = 0.02;    ///< of the electrical span
};

/// A line through the visits, by least squares.
struct Line {
  drivers::TwoPoints points;      ///< on the line, at the mean electrical value of each place
  double slope = 0;               ///< mm or kPa per V or mA; its sign is the sensor's
  std::vector<double> residuals;  ///< reference minus line, per visit [mm or kPa]
  std::optional<double>
      repeat_spread;  ///< largest difference of two visits to one place; nothing: one visit each
  double noise = 0;   ///< standard deviation of one reading, through the slope [mm or kPa]
  /// Of the line between its two places: twice the standard uncertainty of a point, from noise, drift and
  /// repetition. The gauge's own error is not in it: nobody here knows it.
  double error = 0;
};

/// The line, or one sentence why it would be nonsense. `unit` names the reference ("mm"), `electrical` the
/// other.
[[nodiscard]] tl::expected<Line, std::string> fit_line(const std::vector<Visit>& visits,
                                                       const Demands& demands, const std::string& unit,
                                                       const std::string& electrical);

/// Where a response that is flat at first begins to rise.
struct DeadZone {
  double end = 0;            ///< the command up to which nothing follows
  double gain = 0;           ///< slope beyond it
  double scatter = 0;        ///< standard deviation of the response about the fit
  bool significant = false;  ///< the bend explains the response better than a straight line, beyond doubt
};
/// A horizontal and a rising piece, by least squares, over a ramp. Nothing if the response does not rise.
[[nodiscard]] std::optional<DeadZone> find_dead_zone(const std::vector<double>& command,
                                                     const std::vector<double>& response);

}  // namespace softgrip::tools::calibrate
