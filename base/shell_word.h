#pragma once
// Quotes words of a shell command line.

#include <string>
#include <string_view>

namespace softgrip {

/// Returns `text` in a form that a POSIX shell reads as one word. If no character of `text` is special in a
/// shell, the result is the unchanged text. Otherwise, the result is the text in single quotes.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace softgrip
