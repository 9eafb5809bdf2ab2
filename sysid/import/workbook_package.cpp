#include "sysid/import/workbook_package.h"

#include <zip.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {
namespace {

/// Largest size of an archive [bytes]. The list of files in a larger archive could exhaust the memory.
constexpr std::size_t largest_archive_bytes = std::size_t{128} << 20U;
constexpr std::size_t bytes_at_once = std::size_t{1} << 18U;

using Part = std::unique_ptr<zip_file_t, int (*)(zip_file_t*)>;

}  // namespace

WorkbookPackage::WorkbookPackage(Archive archive) : archive_(std::move(archive)), left_(most_text_bytes) {}

tl::expected<WorkbookPackage, std::string> WorkbookPackage::open(std::string_view bytes) {
  if (bytes.size() > largest_archive_bytes)
    return tl::unexpected("the workbook has more than " + std::to_string(largest_archive_bytes) + " bytes");
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
  if (source == nullptr) return tl::unexpected(std::string("libzip cannot be initialised"));
  Archive archive(zip_open_from_source(source, ZIP_RDONLY, nullptr), zip_discard);
  if (!archive) {
    zip_source_free(source);
    return tl::unexpected(std::string("this workbook or archive is broken or cut off"));
  }
  return WorkbookPackage(std::move(archive));
}

bool WorkbookPackage::has(const std::string& part) const {
  return zip_name_locate(archive_.get(), part.c_str(), 0) >= 0;
}

tl::expected<std::string, std::string> WorkbookPackage::read(const std::string& part) {
  const std::string name = "its part '" + document::shown(part) + "' ";
  zip_stat_t state;
  if (zip_stat(archive_.get(), part.c_str(), 0, &state) != 0) return tl::unexpected(name + "is missing");
  if ((state.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && state.encryption_method != ZIP_EM_NONE)
    return tl::unexpected(name + "is encrypted");
  const Part file(zip_fopen(archive_.get(), part.c_str(), 0), zip_fclose);
  if (!file) return tl::unexpected(name + "cannot be read");
  std::string content;
  std::string chunk(bytes_at_once, '\0');
  while (true) {
    const zip_int64_t count = zip_fread(file.get(), chunk.data(), chunk.size());
    if (count < 0) return tl::unexpected(name + "is broken");
    if (count == 0) return content;
    if (static_cast<std::size_t>(count) > left_)
      return tl::unexpected("after decompression the workbook has more than " +
                            std::to_string(most_text_bytes) + " bytes");
    left_ -= static_cast<std::size_t>(count);
    content.append(chunk, 0, static_cast<std::size_t>(count));
  }
}

}  // namespace softgrip::sysid
