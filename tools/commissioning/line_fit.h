#pragma once
// Fits a straight line to measurements at two positions, or reports why no line can be fitted.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/two_points.h"

namespace softgrip::tools::calibrate {

/// One visit to one of the two positions.
struct Visit {
  bool upper = false;     ///< at the position with the larger command; if a person moves the target, at the
                          ///< second position
  double electrical = 0;  ///< mean [V or mA]
  double noise = 0;       ///< standard deviation of one electrical reading
  double drift = 0;  ///< absolute difference between the means of the first and the second half of the visit
  std::size_t count = 0;  ///< number of readings in the mean
  double reference = 0;   ///< reading of the gauge or manometer [mm or kPa]
};

/// Requirements on a calibration. A calibration that does not meet them is refused.
struct Demands {
  double least_span = 0;             ///< smallest difference of the references [mm or kPa]
  double least_electrical_span = 0;  ///< smallest difference of the electrical values [V or mA]
  double most_noise_share = 0.02;    ///< largest noise, as a share of the electrical span
};

/// A straight line through the visits, fitted by least squares.
struct Line {
  drivers::TwoPoints points;  ///< two points on the line, at the mean electrical value of each position
  double slope = 0;  ///< mm or kPa per V or mA; negative if the signal falls when the reference rises
  std::vector<double> residuals;  ///< reference minus line, per visit [mm or kPa]
  std::optional<double>
      repeat_spread;  ///< largest difference of two visits to one position; nullopt: one visit each
  double noise = 0;   ///< standard deviation of one reading, converted by the slope [mm or kPa]
  /// Uncertainty of the line between its two positions: twice the standard uncertainty of a point, from
  /// noise, drift and repeatability. The error of the gauge itself is unknown and not included.
  double error = 0;
};

/// Returns the line, or one sentence that says why the measurements are implausible. `unit` names the unit of
/// the reference ("mm"), `electrical` that of the electrical value.
[[nodiscard]] tl::expected<Line, std::string> fit_line(const std::vector<Visit>& visits,
                                                       const Demands& demands, const std::string& unit,
                                                       const std::string& electrical);

/// The point where an initially constant response begins to rise.
struct DeadZone {
  double end = 0;            ///< the largest command without a response
  double gain = 0;           ///< slope beyond the dead zone
  double scatter = 0;        ///< standard deviation of the response about the fit
  bool significant = false;  ///< the fit with a bend is significantly better than a straight line
};
/// Fits a horizontal and a rising segment to a ramp by least squares. Returns nullopt if the response does
/// not rise.
[[nodiscard]] std::optional<DeadZone> find_dead_zone(const std::vector<double>& command,
                                                     const std::vector<double>& response);

}  // namespace softgrip::tools::calibrate
