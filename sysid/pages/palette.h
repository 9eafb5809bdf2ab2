#pragma once
// The colours of pages and pictures, selected by role, for light and dark screens. Printed pages always use
// the light colours.
//
// The light colour of an element is stored as an attribute, which all SVG programs support. The element also
// has a class, for which the style sheet of a page defines the colour in the reader's colour scheme.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// A colour, named by its role, so that a quantity has the same colour in all pictures of a report. The
/// colours of curves are those of Okabe and Ito, which people with any kind of colour vision can distinguish.
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

/// Returns attributes of an SVG element, with a leading blank. The element inherits the attributes that are
/// not given.
[[nodiscard]] std::string stroked(Colour stroke);
[[nodiscard]] std::string filled(Colour fill, std::optional<Colour> stroke = std::nullopt);

/// Returns CSS that defines the colours of both schemes as variables of `selector`, and the classes that use
/// these variables.
[[nodiscard]] std::string scheme_css(std::string_view selector);

}  // namespace softgrip::sysid
