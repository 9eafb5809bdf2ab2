#pragma once
// Escapes text for HTML and SVG.

#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Returns `text` with entities in place of & < > " ', and with a replacement character in place of each
/// control character. The result is safe as content and as a quoted attribute, for any `text`.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace softgrip::sysid
