#pragma once
// The characters of a foreign text.

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::sysid {

/// UTF-8 without a byte order mark, of UTF-8, UTF-16 with a byte order mark, or Latin-1; lines end with \n.
/// What is no text is a sentence that says so.
[[nodiscard]] tl::expected<std::string, std::string> utf8_of(std::string_view bytes);

}  // namespace softgrip::sysid
