#pragma once
// A figure: charts or a drawing, with a name, a caption and the numbers that it shows.

#include <optional>
#include <string>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// A picture that is no chart.
struct Drawing {
  std::string markup;               ///< SVG elements, of a Canvas
  int width = 760;                  ///< [px]
  int height = 100;                 ///< [px]
  std::vector<std::string> header;  ///< of the numbers that it shows
  std::vector<std::vector<std::string>> rows;
};

struct Figure {
  std::string name;     ///< in a few words, also of its files: "error over time tp1"
  std::string caption;  ///< sentences
  ChartRows charts;
  std::optional<Drawing> drawing = {};  ///< instead of charts
};

/// As an <svg> element for a page, which brings the colours.
[[nodiscard]] std::string svg_of(const Figure& figure);
/// As a file of its own, with both colour schemes.
[[nodiscard]] std::string svg_file_of(const Figure& figure);
/// What the figure shows, as CSV with a header: of each curve its values at full length, `x` once where
/// curves of a chart share it; of a drawing its numbers.
[[nodiscard]] std::string csv_of(const Figure& figure);

}  // namespace softgrip::sysid
