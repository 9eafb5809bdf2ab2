#pragma once
// Defines a figure of a report: charts or a drawing, with a name, a caption and the values that the picture
// shows.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// A picture of a figure that has no charts.
struct Drawing {
  std::string markup;  ///< SVG elements that a Canvas has produced
  int width = 760;     ///< width of the drawing [px]
  int height = 100;    ///< height of the drawing [px]
  /// Names of the columns of `rows`. `rows` contains the values that the drawing shows.
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct Figure {
  /// Short name of the figure: "error over time tp1". This name is also part of the names of the figure's
  /// files.
  std::string name;
  std::string caption;  ///< caption of one or more sentences
  ChartRows charts;
  std::optional<Drawing> drawing = {};  ///< drawing that replaces the charts; absent: the charts are drawn
};

/// Returns the figure as an <svg> element for a page. The style sheet of the page defines the colours.
[[nodiscard]] std::string svg_of(const Figure& figure);
/// Returns the figure as the text of a separate SVG file that contains both colour schemes.
[[nodiscard]] std::string svg_file_of(const Figure& figure);
/// Returns the values of the figure as CSV text with a header line: all values of each curve, or the rows of
/// the drawing. Consecutive curves that have equal x values share one column of x values.
[[nodiscard]] std::string csv_of(const Figure& figure);

}  // namespace softgrip::sysid
