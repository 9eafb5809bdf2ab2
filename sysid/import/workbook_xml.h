#pragma once
// The XML of a workbook's parts; through pugixml, which expands no entities.

#include <string>
#include <string_view>

#include <pugixml.hpp>
#include <tl/expected.hpp>

namespace softgrip::sysid {

/// Replaces `document` by the XML in `text`, which must outlive it. The error is a sentence. XML whose
/// tree could need more than 1 GiB is refused.
[[nodiscard]] tl::expected<void, std::string> load_xml(std::string& text, pugi::xml_document& document);

/// A name without its prefix: "x:row" is "row".
[[nodiscard]] std::string_view local_name(std::string_view name);
/// The first child, or the value of an attribute, of a local name.
[[nodiscard]] pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name);
[[nodiscard]] std::string_view attribute_of(const pugi::xml_node& node, std::string_view name);

/// Returns true for the two words that XML has for it: "1" and "true".
[[nodiscard]] bool is_true(std::string_view word);

/// The text of a shared or an inline string: its `t` elements, also those in runs.
[[nodiscard]] std::string string_in(const pugi::xml_node& node);

}  // namespace softgrip::sysid
