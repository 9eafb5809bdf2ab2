#pragma once
// A figure in the format that a file's name asks for.

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "sysid/pages/figure.h"

namespace softgrip::tools {

enum class PictureFormat { svg, pdf, png, html };

/// By the ending of a path, whatever its case. Nothing where no picture ends so.
[[nodiscard]] std::optional<PictureFormat> picture_format_of(std::string_view path);

/// "svg, pdf, png or html", for messages.
[[nodiscard]] std::string_view picture_formats();

/// The bytes of a file: SVG and HTML in both colour schemes, a PDF of one page of the figure's size, PNG at
/// twice its pixels. The error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> bytes_of(const sysid::Figure& figure,
                                                              PictureFormat format);

}  // namespace softgrip::tools
