#pragma once
// Draws charts as SVG, with lines, points, bands and bars. The SVG contains no script and uses the fonts of
// the reader's system.
//
// A chart contains only data; markup_of() draws the chart as part of a figure (figure.h). Units of axes are
// written in words. Long series are thinned to the resolution of the picture. If x increases, the lowest and
// the highest value of each pixel column are kept. A single outlier among a million samples therefore remains
// visible. In other curves, such as loops, points that coincide with points already drawn are removed.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/palette.h"

namespace softgrip::sysid {

/// Dash pattern of a line, for readers who cannot distinguish lines by colour alone.
enum class Dash { solid, dashed, dotted };

/// One curve. `x` and `y` have the same length; a value that is not finite interrupts the line.
struct Series {
  enum class Style {
    line,
    points,
    band,   ///< the area between the curves y and y_upper
    bars,   ///< bars from 0 to y
    steps,  ///< a line that keeps the value of y until the next x
  };
  std::string label;  ///< text in the legend; "": the legend does not contain the curve
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> y_upper;  ///< upper edge of a band; used if the style is `band`
  Style style = Style::line;
  Colour colour = Colour::measured;
  Dash dash = Dash::solid;
  double width = 1.4;  ///< width of the line, or radius of the points [px]
};

/// A straight line across the chart, with a label. The line is vertical or horizontal.
struct Mark {
  enum class Direction { vertical, horizontal };
  Direction direction = Direction::horizontal;
  double at = 0;
  std::string label;
};

/// An axis of a chart. An axis without limits covers the range of the data.
struct Axis {
  std::string label;  ///< name and unit of the axis: "displacement [mm]"
  std::optional<double> lower;
  std::optional<double> upper;
  bool logarithmic = false;
  std::vector<std::string> categories;  ///< names that label the positions 0, 1, 2, ... in place of numbers
};

struct Chart {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<Mark> marks;
  int width = 760;   ///< width of the chart [px]
  int height = 280;  ///< height of the chart [px]
};

/// Returns a chart whose x axis is labelled with names in place of numbers.
[[nodiscard]] Chart chart_over(std::vector<std::string> names);
/// Returns the points of a chart that chart_over() has created, one value for each name. A value that is NaN
/// gives no point.
[[nodiscard]] Series points_over_names(std::string label, Colour colour, std::vector<double> values);

/// Rows of charts, one below the other. A row contains one chart of full width or several charts side by
/// side.
using ChartRows = std::vector<std::vector<Chart>>;

/// The size of a picture [px].
struct Extent {
  int width = 0;
  int height = 0;
};
/// Returns the size of a picture with these rows. The width is the width of the widest row, and the height is
/// the sum of the heights of the rows.
[[nodiscard]] Extent extent_of(const ChartRows& rows);

/// Returns the charts as SVG elements within the size extent_of(rows). The y axes of charts in the same
/// column are aligned.
[[nodiscard]] std::string markup_of(const ChartRows& rows);

/// Returns one row for each chart.
[[nodiscard]] ChartRows stacked(std::vector<Chart> charts);

}  // namespace softgrip::sysid
