#pragma once
// Draws lines, boxes and texts as SVG elements in the colours of the palette. Charts and drawings are made of
// these elements.

#include <string>
#include <string_view>

#include "sysid/pages/chart_path.h"
#include "sysid/pages/palette.h"

namespace softgrip::sysid {

/// The part of a text that is placed at the given point.
enum class Anchor { start, middle, end };

/// Returns the approximate width of a text [px], for margins and legends. The actual font is unknown.
[[nodiscard]] double text_width(std::string_view text);

/// A sequence of SVG elements. All lengths are in pixels. `more` contains further attributes and begins with
/// a blank.
class Canvas {
 public:
  void line(Pixel from, Pixel to, Colour colour, std::string_view more = {});
  /// Draws a filled rectangle without an edge; framed_box() draws one with an edge.
  void box(double x, double y, double width, double height, Colour fill, std::string_view more = {});
  void framed_box(double x, double y, double width, double height, Colour fill, Colour edge,
                  std::string_view more = {});
  void words(Pixel at, Anchor anchor, std::string_view text, Colour colour = Colour::text,
             std::string_view more = {});
  /// Draws a text that remains readable if it lies on a curve.
  void words_on_curve(Pixel at, Anchor anchor, std::string_view text);
  /// Appends markup that another file of this folder has produced. It is not escaped.
  void raw(std::string_view markup) { markup_ += markup; }

  [[nodiscard]] const std::string& markup() const noexcept { return markup_; }

 private:
  std::string markup_;
};

}  // namespace softgrip::sysid
