#pragma once
// Converts the character encoding of an external text to UTF-8.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"

namespace softgrip::sysid {

/// Converts a text to UTF-8 without a byte order mark. Each line of the result ends with "\n". Accepted
/// encodings are UTF-8, UTF-16 with a byte order mark, and Latin-1. If the bytes are not a text, returns a
/// sentence that describes the error.
[[nodiscard]] tl::expected<std::string, std::string> utf8_of(std::string_view bytes);

struct ForeignText {
  std::string text;  ///< text of the file, in UTF-8 as utf8_of() returns it
  /// Notes about NUL bytes that were removed at the end. A data logger leaves such bytes after a power
  /// failure.
  std::vector<std::string> notes;
};

/// Returns the text of an external file. The text may have at most most_text_bytes bytes and most_rows lines,
/// and each line at most longest_line bytes (table.h). If the text is refused, a problem is added.
[[nodiscard]] std::optional<ForeignText> foreign_text(const std::string& file, std::string_view bytes,
                                                      document::Problems& problems);

}  // namespace softgrip::sysid
