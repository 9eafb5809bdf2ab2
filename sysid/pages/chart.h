#pragma once
// Charts as SVG: lines, points, bands, bars. They contain no script and use the fonts of the reader's system.
//
// A chart is a plain value. markup_of() draws it as part of a figure (figure.h). Units of axes are written in
// words. Long series are thinned to the resolution of the picture. If x increases, the lowest and the highest
// value of each pixel column are kept, so that a single outlier among a million samples remains visible. In
// other curves (loops), points that coincide with points already drawn are removed.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/palette.h"

namespace softgrip::sysid {

/// The dash pattern of a line. Some readers cannot distinguish lines by their colour alone.
enum class Dash { solid, dashed, dotted };

/// One curve. `x` and `y` have the same length; a value that is not finite interrupts the line.
struct Series {
  enum class Style {
    line,
    points,
    band,   ///< area between y and y_upper
    bars,   ///< bars from 0 to y, as wide as possible
    steps,  ///< a line that is horizontal until the next x
  };
  std::string label;  ///< text in the legend; "": not in the legend
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> y_upper;  ///< upper limit of a band
  Style style = Style::line;
  Colour colour = Colour::measured;
  Dash dash = Dash::solid;
  double width = 1.4;  ///< width of the line, or radius of the points [px]
};

/// A straight line across the chart, with a label.
struct Mark {
  enum class Direction { vertical, horizontal };
  Direction direction = Direction::horizontal;
  double at = 0;
  std::string label;
};

/// One axis. Without limits, it covers the range of the data.
struct Axis {
  std::string label;  ///< name and unit: "displacement [mm]"
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

/// Returns a chart whose x axis has names instead of numbers as tick labels.
[[nodiscard]] Chart chart_over(std::vector<std::string> names);
/// Returns points for such a chart, one value per name. NaN: no point.
[[nodiscard]] Series points_over_names(std::string label, Colour colour, std::vector<double> values);

/// Rows of charts, one below the other. A row contains one chart of full width, or several charts side by
/// side.
using ChartRows = std::vector<std::vector<Chart>>;

/// The size of a picture [px].
struct Extent {
  int width = 0;
  int height = 0;
};
/// Returns the size of a picture with these rows: the width of the widest row and the sum of the heights.
[[nodiscard]] Extent extent_of(const ChartRows& rows);

/// Returns the charts as SVG elements that fit into extent_of(). The y axes of charts in one column are
/// aligned.
[[nodiscard]] std::string markup_of(const ChartRows& rows);

/// Returns rows with one chart each.
[[nodiscard]] ChartRows stacked(std::vector<Chart> charts);

}  // namespace softgrip::sysid
