#include "tools/figures/figure_files.h"

#include <cstddef>
#include <filesystem>

#include "base/files.h"
#include "sysid/pages/page.h"
#include "tools/figures/picture_format.h"

namespace softgrip::tools {

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

}  // namespace softgrip::tools
