#pragma once
// Recognises UTF-8 characters and control characters in bytes, and converts all bytes to a form that can be
// shown.

#include <cstddef>
#include <string>
#include <string_view>

namespace softgrip::document {

/// Returns the length of the first UTF-8 character of `text` in bytes; 0 if the first bytes are not UTF-8
/// (overlong forms, surrogates and values above U+10FFFF included). `text` is not empty.
[[nodiscard]] std::size_t character_length(std::string_view text) noexcept;

/// Returns true if a character is a control character (U+0000 to U+001F, U+007F to U+009F). The character
/// must be valid and have 1 or 2 bytes.
[[nodiscard]] bool is_control(std::string_view character) noexcept;

/// Moves the first character of `text` to `out`, in a form that is safe for a terminal. Returns the number of
/// terminal columns of this form. `text` is not empty.
std::size_t append_visible(std::string& out, std::string_view& text);

}  // namespace softgrip::document
