#pragma once
// Recognises UTF-8 characters and control characters in a text, and converts any bytes to a form that a
// terminal can show.

#include <cstddef>
#include <string>
#include <string_view>

namespace softgrip::document {

/// Returns the length of the first UTF-8 character of `text` in bytes. Returns 0 if the first bytes are not
/// valid UTF-8; overlong forms, surrogates and values above U+10FFFF are not valid. `text` must not be empty.
[[nodiscard]] std::size_t character_length(std::string_view text) noexcept;

/// Returns true if a character is a control character (U+0000 to U+001F, U+007F to U+009F). The character
/// must be valid and have 1 or 2 bytes.
[[nodiscard]] bool is_control(std::string_view character) noexcept;

/// Removes the first character from `text` and appends it to `out`, after control characters and invalid
/// bytes are made visible. Returns the number of terminal columns that were appended. `text` must not be
/// empty.
std::size_t append_visible(std::string& out, std::string_view& text);

}  // namespace softgrip::document
