#pragma once
// Draws lines, boxes and texts as SVG elements in the colours of the palette. Charts and drawings are made of
// these elements.

#include <string>
#include <string_view>

#include "sysid/pages/chart_path.h"
#include "sysid/pages/palette.h"

namespace softgrip::sysid {

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
