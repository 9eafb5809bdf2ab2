#pragma once
// Bytes to characters: what is UTF-8, what is a control character, how either is shown.

#include <cstddef>
#include <string>
#include <string_view>

namespace softgrip::document {

/// The length in bytes of the UTF-8 character that `text` starts with, 0 if its first bytes are not UTF-8
/// (overlong forms, surrogates and beyond U+10FFFF included). `text` is not empty.
[[nodiscard]] std::size_t character_length(std::string_view text) noexcept;

/// True if the character (1 or 2 bytes, valid) is a control character: U+0000-001F, U+007F-009F.
[[nodiscard]] bool is_control(std::string_view character) noexcept;

/// Appends the first character of `text` as a terminal may see it and takes it off `text`; returns how many
/// columns it takes. `text` is not empty.
std::size_t append_visible(std::string& out, std::string_view& text);

}  // namespace softgrip::document
