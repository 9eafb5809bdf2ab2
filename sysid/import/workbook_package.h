#pragma once
// Reads the files (parts) in an .xlsx workbook, which is a ZIP archive. Uses libzip.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

struct zip;

namespace softgrip::sysid {

/// Reads the parts of a workbook archive that is in memory. `bytes` must outlive the object. All parts
/// together may have at most `most_text_bytes` (table.h) after decompression. The sizes that the archive
/// states are not trusted.
class WorkbookPackage {
 public:
  /// Opens the archive. On failure, returns a sentence that describes the error.
  [[nodiscard]] static tl::expected<WorkbookPackage, std::string> open(std::string_view bytes);

  [[nodiscard]] bool has(const std::string& part) const;
  /// Returns the content of a part. On failure, returns a sentence that describes the error.
  [[nodiscard]] tl::expected<std::string, std::string> read(const std::string& part);

 private:
  using Archive = std::unique_ptr<zip, void (*)(zip*)>;
  explicit WorkbookPackage(Archive archive);

  Archive archive_;
  std::size_t left_;  ///< number of decompressed bytes that may be read from now on
};

}  // namespace softgrip::sysid
