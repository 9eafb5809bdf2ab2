#pragma once
// A figure: charts or a drawing, with a name, a caption and the values that it shows.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// A picture that is not a chart.
struct Drawing {
  std::string markup;               ///< SVG elements from a Canvas
  int width = 760;                  ///< [px]
  int height = 100;                 ///< [px]
  std::vector<std::string> header;  ///< column names of `rows`, the values that the drawing shows
  std::vector<std::vector<std::string>> rows;
};

struct Figure {
  std::string name;     ///< a few words, also used for its files: "error over time tp1"
  std::string caption;  ///< one or more sentences
  ChartRows charts;
  std::optional<Drawing> drawing = {};  ///< instead of charts
};

/// Returns the figure as an <svg> element. The page defines the colours.
[[nodiscard]] std::string svg_of(const Figure& figure);
/// Returns the figure as a separate file with both colour schemes.
[[nodiscard]] std::string svg_file_of(const Figure& figure);
/// Returns the values of the figure as CSV with a header: all values of each curve, or the rows of the
/// drawing. Curves of a chart that have equal x values share one column `x`.
[[nodiscard]] std::string csv_of(const Figure& figure);

}  // namespace softgrip::sysid
