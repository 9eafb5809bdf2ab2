#pragma once
// SVG drawn on other paper, by librsvg and cairo.

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::tools {

/// One page of the picture's size, a pixel being 0.75 points; words stay words. The error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> pdf_of(std::string_view svg);

/// At twice its pixels, on white.
[[nodiscard]] tl::expected<std::string, std::string> png_of(std::string_view svg);

}  // namespace softgrip::tools
