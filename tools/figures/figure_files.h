#pragma once
// Writes the files of a report, and converts figures to SVG, PDF, PNG and HTML files for a paper or for other
// plotting programs.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/pages/page.h"

namespace softgrip::tools {

enum class PictureFormat { svg, pdf, png, html };

/// Returns the format for the extension of a path. The extension may have upper or lower case. Returns
/// nullopt if the extension is unknown.
[[nodiscard]] std::optional<PictureFormat> picture_format_of(std::string_view path);

/// Returns "svg, pdf, png or html", the list of formats for messages.
[[nodiscard]] std::string_view picture_formats();

/// Returns the bytes of a file in the given format. SVG and HTML have a light and a dark colour scheme. PDF
/// has one page of the size of the figure. PNG has twice as many pixels in each direction as the figure. On
/// failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<std::string, std::string> bytes_of(const sysid::Figure& figure,
                                                              PictureFormat format);

/// Writes figure-N-NAME.svg, .pdf and .csv for each figure. N is the number of the figure on the page of the
/// report. Writes nothing if `folder` is empty. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<void, std::string> write_figures(const std::string& folder,
                                                            const std::vector<sysid::Figure>& figures);

/// Returns a PDF with one page of the size of the picture, at 0.75 points per pixel. The PDF contains texts
/// as text, not as outlines. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<std::string, std::string> pdf_of(std::string_view svg);

/// Returns a PNG on a white background, with twice as many pixels in each direction as the picture.
[[nodiscard]] tl::expected<std::string, std::string> png_of(std::string_view svg);

/// Writes the files (name and content) and report.html into the folder `out`, and the figures of the page
/// into the folder `figures`. Writes nothing for a folder whose name is empty. On failure, returns a sentence
/// that describes the error.
[[nodiscard]] tl::expected<void, std::string> write_report(
    const std::string& out, const std::vector<std::pair<std::string, std::string>>& files,
    const sysid::Page& page, const std::string& figures);

}  // namespace softgrip::tools
