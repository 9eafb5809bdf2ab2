#pragma once
// Draws lines, boxes and texts as SVG elements in the colours of the palette. Charts and drawings are made of
// these elements. Curves are converted to SVG path data, without the points that the resolution of a picture
// cannot show.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/pages/palette.h"

namespace softgrip::sysid {

/// A point in pixels. A point that is not finite interrupts the curve.
struct Pixel {
  double x;
  double y;
};

/// Removes the points of a curve that a reader cannot see. If x increases throughout, the lowest and the
/// highest point of each pixel column are kept in their order; if a column has at most four points, all of
/// them are kept. Otherwise the points are rounded to a grid of 1/3 pixel, and repeated points and strokes
/// are removed. If too many strokes remain, points less than 2 pixels from the last kept point are removed.
/// If the number of strokes is still too large, the result is the area that the points cover.
[[nodiscard]] std::vector<Pixel> thinned(const std::vector<Pixel>& curve);

/// Returns vertical strokes in adjacent pixel columns that cover the area of a cloud of points.
[[nodiscard]] std::vector<Pixel> ground_of(const std::vector<Pixel>& cloud);

/// Rounds points that are drawn as dots to a grid of 0.5 pixel. Removes repeated dots and dots that are not
/// finite. If a reader could not distinguish the remaining number of dots from a filled area, returns
/// nullopt.
[[nodiscard]] std::optional<std::vector<Pixel>> distinct_dots(const std::vector<Pixel>& dots);

/// Returns SVG path data such as "M1.5 2l3 4...", which consist of relative moves with a resolution of 0.1
/// pixel.
[[nodiscard]] std::string path_data(const std::vector<Pixel>& curve);

/// Part of a text that is placed at the given horizontal position: the start, the middle or the end of the
/// text.
enum class Anchor { start, middle, end };

/// Returns the width of a text [px] for margins and legends. The width is approximate, because the font of
/// the reader's system is unknown.
[[nodiscard]] double text_width(std::string_view text);

/// A sequence of SVG elements. All lengths are in pixels. The parameter `more` of a function contains
/// additional SVG attributes and begins with a blank.
class Canvas {
 public:
  void line(Pixel from, Pixel to, Colour colour, std::string_view more = {});
  /// Draws a filled rectangle without a border; framed_box() draws a rectangle with a border.
  void box(double x, double y, double width, double height, Colour fill, std::string_view more = {});
  void framed_box(double x, double y, double width, double height, Colour fill, Colour edge,
                  std::string_view more = {});
  void words(Pixel at, Anchor anchor, std::string_view text, Colour colour = Colour::text,
             std::string_view more = {});
  /// Draws a text with an outline that keeps the text readable on a curve.
  void words_on_curve(Pixel at, Anchor anchor, std::string_view text);
  /// Appends SVG markup without escaping it. The markup must be produced by the code in this folder.
  void raw(std::string_view markup) { markup_ += markup; }

  [[nodiscard]] const std::string& markup() const noexcept { return markup_; }

 private:
  std::string markup_;
};

}  // namespace softgrip::sysid
