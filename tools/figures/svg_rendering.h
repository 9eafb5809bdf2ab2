#pragma once
// Renders SVG as PDF or PNG with librsvg and cairo.

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::tools {

/// Returns a PDF with one page of the size of the picture, at 0.75 points per pixel. The PDF contains texts
/// as text, not as outlines. The error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> pdf_of(std::string_view svg);

/// Returns a PNG on a white background, with twice as many pixels in each direction as the picture.
[[nodiscard]] tl::expected<std::string, std::string> png_of(std::string_view svg);

}  // namespace softgrip::tools
