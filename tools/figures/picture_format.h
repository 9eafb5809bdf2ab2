#pragma once
// Converts a figure to the format that a file's extension selects.

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "sysid/pages/figure.h"

namespace softgrip::tools {

enum class PictureFormat { svg, pdf, png, html };

/// Returns the format for the extension of a path. The extension may have upper or lower case. Returns
/// nullopt if it is unknown.
[[nodiscard]] std::optional<PictureFormat> picture_format_of(std::string_view path);

/// Returns "svg, pdf, png or html", the list of formats for messages.
[[nodiscard]] std::string_view picture_formats();

/// Returns the bytes of a file in the given format. SVG and HTML have a light and a dark colour scheme. PDF
/// has one page of the size of the figure. PNG has twice as many pixels in each direction as the figure. The
/// error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> bytes_of(const sysid::Figure& figure,
                                                              PictureFormat format);

}  // namespace softgrip::tools
