#pragma once
// Escaping of text for HTML and SVG.

#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Returns `text` with & < > " ' replaced by entities and control characters by a replacement character. The
/// result is safe as content and as a quoted attribute, for any `text`.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace softgrip::sysid
