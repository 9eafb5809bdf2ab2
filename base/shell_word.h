#pragma once
// Quotes words of a shell command line.

#include <string>
#include <string_view>

namespace softgrip {

/// Returns `text` so that a POSIX shell reads it as one word: unchanged if no character is special, otherwise
/// in single quotes.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace softgrip
