#pragma once
// Renders SVG as PDF or PNG with librsvg and cairo.

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::tools {

/// Returns a PDF with one page of the picture's size, at 0.75 points per pixel. Text stays text. The error is
/// a sentence.
[[nodiscard]] tl::expected<std::string, std::string> pdf_of(std::string_view svg);

/// Returns a PNG at twice the number of pixels, on white.
[[nodiscard]] tl::expected<std::string, std::string> png_of(std::string_view svg);

}  // namespace softgrip::tools
