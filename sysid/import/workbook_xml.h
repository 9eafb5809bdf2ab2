#pragma once
// Parses the XML files in a workbook. Uses pugixml, which expands no entities.

#include <string>
#include <string_view>

#include <pugixml.hpp>
#include <tl/expected.hpp>

namespace softgrip::sysid {

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
