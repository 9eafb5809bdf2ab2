#pragma once
// Words of a command line that a shell reads.

#include <string>
#include <string_view>

namespace softgrip {

/// `text` as a POSIX shell takes it for one word: as it is where nothing in it means more, else in single
/// quotes.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace softgrip
