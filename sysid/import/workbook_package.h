#pragma once
// Reader of the parts of an .xlsx workbook, which is a ZIP archive; uses libzip.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

struct zip;

namespace softgrip::sysid {

/// Reads the parts of an archive in memory. `bytes` must outlive the object. All parts together may have at
/// most `most_text_bytes` (table.h) after decompression, regardless of the sizes that the archive states.
class WorkbookPackage {
 public:
  /// Opens the archive. The error is a sentence.
  [[nodiscard]] static tl::expected<WorkbookPackage, std::string> open(std::string_view bytes);

  [[nodiscard]] bool has(const std::string& part) const;
  /// Returns the content of a part. The error is a sentence.
  [[nodiscard]] tl::expected<std::string, std::string> read(const std::string& part);

 private:
  using Archive = std::unique_ptr<zip, void (*)(zip*)>;
  explicit WorkbookPackage(Archive archive);

  Archive archive_;
  std::size_t left_;  ///< bytes that may still be read
};

}  // namespace softgrip::sysid
