#pragma once
// Charts as SVG: lines, points, bands, bars. No script, no style sheet, no font but the reader's own.
//
// A chart is a plain value; to_svg() draws it. Long series are thinned to what the picture can show: where x
// increases, each pixel column keeps its first, lowest, highest and last value, so that a single outlier
// among a million samples stays visible; other curves (loops) lose points that fall on drawn ground.

#include <optional>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// A colour by its role, so that one thing looks alike in all charts of a report.
enum class Colour { measured, model, error, other, faint, good, bad };

/// One curve. `x` and `y` have the same length; a value that is not finite interrupts the line.
struct Series {
  enum class Style {
    line,
    points,
    band,   ///< filled between y and y_upper
    bars,   ///< from 0 to y, as wide as their spacing allows
    steps,  ///< a line that keeps its value until the next x
  };
  std::string label;  ///< in the legend; "" keeps it out
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> y_upper;  ///< of a band
  Style style = Style::line;
  Colour colour = Colour::measured;
  bool dashed = false;
  double width = 1.4;  ///< of the line, or radius of the points [px]
};

/// A straight line across the chart, with a word beside it.
struct Mark {
  enum class Direction { vertical, horizontal };
  Direction direction = Direction::horizontal;
  double at = 0;
  std::string label;
};

/// One axis. Without limits it covers the data.
struct Axis {
  std::string label;  ///< with its unit: "displacement [mm]"
  std::optional<double> lower;
  std::optional<double> upper;
  bool logarithmic = false;
  std::vector<std::string> categories;  ///< names at 0, 1, 2, ... instead of numbers
};

struct Chart {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<Mark> marks;
  int width = 760;   ///< [px]
  int height = 280;  ///< [px]
};

/// The chart as an <svg> element, complete for a file of its own or for a page.
[[nodiscard]] std::string to_svg(const Chart& chart);

/// Several charts in one picture, one below the other, all of the first one's width.
[[nodiscard]] std::string to_svg(const std::vector<Chart>& stacked);

}  // namespace softgrip::sysid
