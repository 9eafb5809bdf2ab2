#pragma once
// The colours of pages and pictures by role, for light and dark screens; paper is always light.
//
// An element carries its light colour as an attribute, which every program that reads SVG knows, and a class
// that a browser's style sheet gives the colour of the reader's scheme.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// A colour by its role, so that one thing looks alike in all pictures of a report. The curves' are Okabe and
/// Ito's, distinct for all kinds of colour vision.
enum class Colour {
  measured,
  model,
  error,
  other,
  faint,
  good,
  bad,
  text,
  muted,  ///< of a text that stands back
  axis,
  grid,
  paper,  ///< what is drawn upon
  panel,  ///< a box upon the paper
};

/// "#0072b2": of the light scheme.
[[nodiscard]] std::string_view light_code(Colour colour);

/// Attributes of an SVG element, with a blank before them. What is not given is inherited.
[[nodiscard]] std::string stroked(Colour stroke);
[[nodiscard]] std::string filled(Colour fill, std::optional<Colour> stroke = std::nullopt);

/// Both schemes as variables of `selector`, and the classes that use them.
[[nodiscard]] std::string scheme_css(std::string_view selector);

}  // namespace softgrip::sysid
