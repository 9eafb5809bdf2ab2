#pragma once
// The colours of pages and pictures by role, for light and dark screens. Paper is always light.
//
// An element has its light colour as an attribute, which all SVG programs support. It also has a class, for
// which the style sheet of a page defines the colour in the reader's scheme.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// A colour by its role, so that one quantity has the same colour in all pictures of a report. The colours of
/// curves are those of Okabe and Ito, which are distinct for all kinds of colour vision.
enum class Colour {
  measured,
  model,
  error,
  other,
  faint,
  good,
  bad,
  text,
  muted,  ///< secondary text
  axis,
  grid,
  paper,  ///< background
  panel,  ///< a box on the background
};

/// Returns the colour code of the light scheme, such as "#0072b2".
[[nodiscard]] std::string_view light_code(Colour colour);

/// Returns attributes of an SVG element, beginning with a blank. An element inherits attributes that are not
/// given.
[[nodiscard]] std::string stroked(Colour stroke);
[[nodiscard]] std::string filled(Colour fill, std::optional<Colour> stroke = std::nullopt);

/// Returns CSS with both schemes as variables of `selector`, and the classes that use them.
[[nodiscard]] std::string scheme_css(std::string_view selector);

}  // namespace softgrip::sysid
