#pragma once
// Lines, boxes and words as SVG elements in the palette's colours: what charts and drawings are made of.

#include <string>
#include <string_view>

#include "sysid/pages/chart_path.h"
#include "sysid/pages/palette.h"

namespace softgrip::sysid {

/// Where a text stands beside its point.
enum class Anchor { start, middle, end };

/// Width of a text, about: for margins and legends without a font at hand [px].
[[nodiscard]] double text_width(std::string_view text);

/// SVG elements, one after the other. All lengths in pixels; `more` is further attributes, with a blank
/// before.
class Canvas {
 public:
  void line(Pixel from, Pixel to, Colour colour, std::string_view more = {});
  /// A closed area without an edge, or with one.
  void box(double x, double y, double width, double height, Colour fill, std::string_view more = {});
  void framed_box(double x, double y, double width, double height, Colour fill, Colour edge,
                  std::string_view more = {});
  void words(Pixel at, Anchor anchor, std::string_view text, Colour colour = Colour::text,
             std::string_view more = {});
  /// Words that stay readable on a curve.
  void words_on_curve(Pixel at, Anchor anchor, std::string_view text);
  /// Markup made elsewhere in this room.
  void raw(std::string_view markup) { markup_ += markup; }

  [[nodiscard]] const std::string& markup() const noexcept { return markup_; }

 private:
  std::string markup_;
};

}  // namespace softgrip::sysid
