#pragma once
// Text that is safe inside HTML and SVG.

#include <string>
#include <string_view>

namespace softgrip::sysid {

/// `text` with & < > " ' replaced by entities and control characters by a replacement character: safe as
/// content and as a quoted attribute, whatever it came from.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace softgrip::sysid
