#pragma once
// Reads the files (parts) in an .xlsx workbook, which is a ZIP archive. Uses libzip.
// Parses the XML files in a workbook. Uses pugixml, which expands no entities.

#include <cstddef>
#include <memory>
#include <pugixml.hpp>
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

/// Parses the XML in `text` into `document`. `text` must outlive the document. XML whose tree could need more
/// than 1 GiB of memory is refused. On failure, returns a sentence that describes the error.
[[nodiscard]] tl::expected<void, std::string> load_xml(std::string& text, pugi::xml_document& document);

/// Returns an XML name without its namespace prefix: "x:row" gives "row".
[[nodiscard]] std::string_view local_name(std::string_view name);
/// Returns the first child element of `node` whose local name is `name`; an empty node if there is none.
[[nodiscard]] pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name);
/// Returns the value of the first attribute of `node` whose local name is `name`; an empty text if there is
/// none.
[[nodiscard]] std::string_view attribute_of(const pugi::xml_node& node, std::string_view name);

/// Returns true for "1" and "true", the two spellings of a true value in XML.
[[nodiscard]] bool is_true(std::string_view word);

/// Returns the text of a shared or an inline string: the text of all its `t` elements, including those in
/// formatted runs.
[[nodiscard]] std::string string_in(const pugi::xml_node& node);

}  // namespace softgrip::sysid
