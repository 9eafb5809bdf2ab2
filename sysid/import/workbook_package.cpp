#include "sysid/import/workbook_package.h"

#include <zip.h>

#include <algorithm>
#include <cstddef>
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

constexpr std::size_t most_tree_bytes = std::size_t{1} << 30U;
// Sizes of an XML node and of an XML attribute in pugixml on a 64-bit machine [bytes].
constexpr std::size_t node_bytes = 64;
constexpr std::size_t attribute_bytes = 40;

/// Returns an upper bound of the memory that the XML tree of `text` needs [bytes]. The first text in an
/// element is not counted, because pugixml stores it in the node of the element.
std::size_t tree_bytes(std::string_view text) {
  std::size_t bytes = 0;
  bool opens = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '=') bytes += attribute_bytes;
    if (text[i] == '<') {
      opens = i + 1 < text.size() && text[i + 1] != '/';
      bytes += opens ? node_bytes : 0;
    } else if (text[i] == '>') {
      const bool first = opens && text[i - 1] != '/';
      const std::size_t next = text.find_first_not_of(" \t\r\n", i + 1);
      const bool is_text = next != std::string_view::npos && text[next] != '<';
      bytes += is_text && !first ? node_bytes : 0;
    }
  }
  return bytes;
}

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

tl::expected<void, std::string> load_xml(std::string& text, pugi::xml_document& document) {
  if (tree_bytes(text) > most_tree_bytes) return tl::unexpected(std::string("the sheet has too many cells"));
  constexpr unsigned options = pugi::parse_default | pugi::parse_embed_pcdata;
  const pugi::xml_parse_result result = document.load_buffer_inplace(text.data(), text.size(), options);
  if (!result)
    return tl::unexpected("byte " + std::to_string(result.offset) +
                          " of its XML: " + std::string(result.description()));
  return {};
}

std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node& child : node.children()) {
    if (local_name(child.name()) == name) return child;
  }
  return {};
}

std::string_view attribute_of(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    if (local_name(attribute.name()) == name) return attribute.value();
  }
  return {};
}

bool is_true(std::string_view word) {
  return word == "1" || word == "true";
}

std::string string_in(const pugi::xml_node& node) {
  std::string text;
  for (const pugi::xml_node& child : node.children()) {
    const std::string_view name = local_name(child.name());
    if (name == "t") text += child.child_value();
    if (name == "r") text += child_of(child, "t").child_value();
  }
  return text;
}

}  // namespace softgrip::sysid
