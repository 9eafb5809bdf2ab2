#pragma once
// A figure: charts or a drawing, with a name, a caption and the values that the picture shows.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// A picture that is not a chart.
struct Drawing {
  std::string markup;  ///< SVG elements from a Canvas
  int width = 760;     ///< [px]
  int height = 100;    ///< [px]
  /// Column names of `rows`, which contain the values that the drawing shows.
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct Figure {
  /// A few words, which are also used for the names of the figure's files: "error over time tp1".
  std::string name;
  std::string caption;  ///< one or more sentences
  ChartRows charts;
  std::optional<Drawing> drawing = {};  ///< if set, drawn instead of charts
};

/// Returns the figure as an <svg> element. The page defines the colours.
[[nodiscard]] std::string svg_of(const Figure& figure);
/// Returns the figure as a separate file with both colour schemes.
[[nodiscard]] std::string svg_file_of(const Figure& figure);
/// Returns the values of the figure as CSV with a header: all values of each curve, or the rows of the
/// drawing. If curves of a chart have equal x values, they share one column `x`.
[[nodiscard]] std::string csv_of(const Figure& figure);

}  // namespace softgrip::sysid
