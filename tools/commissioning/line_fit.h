#pragma once
// Fits a straight line to measurements at two positions, or reports why no line can be fitted.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "drivers/board/board_map.h"

namespace softgrip::tools::calibrate {

/// The measurements of one visit to one of the two calibration positions.
struct Visit {
  bool upper = false;  ///< true: the visit is at the position with the larger command; if a person moves the
                       ///< target: at the second position
  double electrical = 0;  ///< mean electrical value during the visit [V or mA]
  double noise = 0;       ///< standard deviation of one electrical reading [V or mA]
  double drift = 0;  ///< absolute difference between the mean of the first half of the visit and the mean of
                     ///< the second half [V or mA]
  std::size_t count = 0;  ///< number of readings during the visit
  double reference = 0;   ///< value that the gauge or manometer shows [mm or kPa]
};

/// Requirements on the measurements of a calibration. Measurements that do not meet them are refused.
struct Demands {
  double least_span = 0;             ///< smallest difference between the references of the two positions [mm
                                     ///< or kPa]
  double least_electrical_span = 0;  ///< smallest difference between the electrical values of the two
                                     ///< positions [V or mA]
  double most_noise_share = 0.02;    ///< largest permitted noise, as a share of the difference between
                                     ///< electrical values of the two positions
};

/// A straight line through the visits, fitted by least squares.
struct Line {
  drivers::TwoPoints points;  ///< two points on the line, at the mean electrical value of each position
  double slope = 0;  ///< slope [mm or kPa per V or mA]; negative if the signal falls when the reference rises
  std::vector<double> residuals;        ///< reference minus line for each visit [mm or kPa]
  std::optional<double> repeat_spread;  ///< largest difference between two visits to the same position [mm or
                                        ///< kPa]; nullopt: there was one visit to each position
  double noise = 0;  ///< standard deviation of one reading, converted by the slope [mm or kPa]
  /// Uncertainty of the line between its two positions [mm or kPa]: twice the standard uncertainty of a
  /// point, from noise, drift and repeatability. The unknown error of the gauge is not included.
  double error = 0;
};

/// Returns the line, or one sentence that says why the measurements are implausible. `unit` is the unit of
/// the reference, for example "mm". `electrical` is the unit of the electrical value.
[[nodiscard]] tl::expected<Line, std::string> fit_line(const std::vector<Visit>& visits,
                                                       const Demands& demands, const std::string& unit,
                                                       const std::string& electrical);

/// The dead zone of a valve: a range of commands in which the response stays constant before it rises.
struct DeadZone {
  double end = 0;            ///< the largest command at which the response is constant
  double gain = 0;           ///< slope of the response beyond the dead zone
  double scatter = 0;        ///< standard deviation of the difference between response and fit
  bool significant = false;  ///< true: the fit with a bend is significantly better than a straight line
};
/// Fits a horizontal and a rising segment to the response during a ramp, by least squares. Returns nullopt if
/// the response does not rise.
[[nodiscard]] std::optional<DeadZone> find_dead_zone(const std::vector<double>& command,
                                                     const std::vector<double>& response);

}  // namespace softgrip::tools::calibrate
