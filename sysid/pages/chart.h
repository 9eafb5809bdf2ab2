#pragma once
// Charts as SVG: lines, points, bands, bars. No script, no font but the reader's own.
//
// A chart is a plain value; markup_of() draws it, in a figure (figure.h). Units of axes are drawn in words.
// Long series are thinned to what the picture can show: where x increases, each pixel column keeps its first,
// lowest, highest and last value, so that a single outlier among a million samples stays visible; other
// curves (loops) lose points that fall on drawn ground.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/palette.h"

namespace softgrip::sysid {

/// How a line is drawn, beside its colour: what is told apart by colour alone, some readers cannot tell.
enum class Dash { solid, dashed, dotted };

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
  Dash dash = Dash::solid;
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

/// A chart of which the x axis has names instead of numbers, for series over them.
[[nodiscard]] Chart chart_over(std::vector<std::string> names);
/// Points over the names of such a chart, one value for each; NaN: none.
[[nodiscard]] Series points_over_names(std::string label, Colour colour, std::vector<double> values);

/// Rows of charts, one below the other: each a chart of full width, or several side by side.
using ChartRows = std::vector<std::vector<Chart>>;

/// [px]
struct Extent {
  int width = 0;
  int height = 0;
};
/// Width of the widest row, heights together.
[[nodiscard]] Extent extent_of(const ChartRows& rows);

/// The charts as SVG elements within that extent. Charts of a column have their axes below each other.
[[nodiscard]] std::string markup_of(const ChartRows& rows);

/// One chart below the other.
[[nodiscard]] ChartRows stacked(std::vector<Chart> charts);

}  // namespace softgrip::sysid
