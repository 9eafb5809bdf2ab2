#pragma once
// Defines the colours of pages and pictures for light and dark screens. Each colour is selected by its role.
// Printed pages always use the light colours.
//
// The light colour of an element is stored as an attribute, which all SVG programs support. The element also
// has a class. For this class, the style sheet of a page defines the colour in the reader's colour scheme.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Role of a colour. All pictures of a report draw a quantity in the colour of its role. The colours of
/// curves are the palette of Okabe and Ito, which people with any kind of colour vision can distinguish.
enum class Colour {
  measured,
  model,
  error,
  other,
  faint,
  good,
  bad,
  text,
  muted,  ///< colour of text that is less important
  axis,
  grid,
  paper,  ///< colour of the background of the page
  panel,  ///< colour of the background of a box on the page
};

/// Returns attributes that set the colours of an SVG element. The text begins with a blank. If a colour is
/// not passed, the element inherits the attribute of this colour.
[[nodiscard]] std::string stroked(Colour stroke);
[[nodiscard]] std::string filled(Colour fill, std::optional<Colour> stroke = std::nullopt);

/// Returns CSS that defines the colours of both schemes as variables of `selector`. The CSS also defines the
/// classes that use these variables.
[[nodiscard]] std::string scheme_css(std::string_view selector);

}  // namespace softgrip::sysid
