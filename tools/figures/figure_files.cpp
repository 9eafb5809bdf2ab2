#include "tools/figures/figure_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <filesystem>

#include "base/files.h"

namespace softgrip::tools {
namespace {

std::string html_of(const sysid::Figure& figure) {
  sysid::Page page(figure.name, figure.caption, sysid::Tone::good);
  page.provenance({{"software", sysid::software_and_version()}});
  page.figure(figure);
  return page.to_html();
}

}  // namespace

std::optional<PictureFormat> picture_format_of(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, PictureFormat>, 4> endings{{
      {".svg", PictureFormat::svg},
      {".pdf", PictureFormat::pdf},
      {".png", PictureFormat::png},
      {".html", PictureFormat::html},
  }};
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [name, format] : endings) {
    if (ending == name) return format;
  }
  return std::nullopt;
}

std::string_view picture_formats() {
  return "svg, pdf, png or html";
}

tl::expected<std::string, std::string> bytes_of(const sysid::Figure& figure, PictureFormat format) {
  switch (format) {
    case PictureFormat::svg:
      return sysid::svg_file_of(figure);
    case PictureFormat::pdf:
      return pdf_of(sysid::svg_file_of(figure));
    case PictureFormat::png:
      return png_of(sysid::svg_file_of(figure));
    case PictureFormat::html:
      return html_of(figure);
  }
  return tl::unexpected(std::string("no such format"));
}

tl::expected<void, std::string> write_figures(const std::string& folder,
                                              const std::vector<sysid::Figure>& figures) {
  if (folder.empty()) return {};
  const std::filesystem::path out(folder);
  const auto write = [&](const std::string& name, const std::string& bytes) {
    return write_file((out / name).string(), bytes);
  };
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const std::string stem = sysid::figure_stem(i + 1, figures[i].name);
    const auto pdf = bytes_of(figures[i], PictureFormat::pdf);
    if (!pdf) return tl::unexpected(pdf.error());
    if (auto written = write(stem + ".svg", sysid::svg_file_of(figures[i])); !written) return written;
    if (auto written = write(stem + ".pdf", *pdf); !written) return written;
    if (auto written = write(stem + ".csv", sysid::csv_of(figures[i])); !written) return written;
  }
  return {};
}

tl::expected<void, std::string> write_report(const std::string& out,
                                             const std::vector<std::pair<std::string, std::string>>& files,
                                             const sysid::Page& page, const std::string& figures) {
  const auto write = [&](const std::string& name, const std::string& text) {
    return write_file((std::filesystem::path(out) / name).string(), text);
  };
  if (!out.empty()) {
    for (const auto& [name, text] : files) {
      if (auto written = write(name, text); !written) return written;
    }
    if (auto written = write("report.html", page.to_html()); !written) return written;
  }
  return write_figures(figures, page.figures());
}

}  // namespace softgrip::tools
