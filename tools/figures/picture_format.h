#pragma once
// Converts a figure to the format that a file's extension selects.

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "sysid/pages/figure.h"

namespace softgrip::tools {

enum class PictureFormat { svg, pdf, png, html };

/// Returns the format for the extension of a path, in upper or lower case. Returns nullopt for an unknown
/// extension.
[[nodiscard]] std::optional<PictureFormat> picture_format_of(std::string_view path);

/// Returns "svg, pdf, png or html" for messages.
[[nodiscard]] std::string_view picture_formats();

/// Returns the bytes of a file in the given format: SVG or HTML with a light and a dark colour scheme, PDF
/// with one page of the size of the figure, or PNG with twice as many pixels in each direction. The error is
/// a sentence.
[[nodiscard]] tl::expected<std::string, std::string> bytes_of(const sysid::Figure& figure,
                                                              PictureFormat format);

}  // namespace softgrip::tools
