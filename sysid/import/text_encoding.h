#pragma once
// Character encoding of an external text.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"

namespace softgrip::sysid {

/// Converts UTF-8, UTF-16 with a byte order mark, or Latin-1 to UTF-8 without a byte order mark; lines end
/// with \n. If the bytes are not a text, the error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> utf8_of(std::string_view bytes);

struct ForeignText {
  std::string text;  ///< see utf8_of()
  /// Notes about removed NUL bytes at the end, which a data logger leaves after a power failure.
  std::vector<std::string> notes;
};

/// Returns the text of an external file with at most most_text_bytes bytes and most_rows lines of at most
/// longest_line bytes (table.h). If the text is refused, a problem is added.
[[nodiscard]] std::optional<ForeignText> foreign_text(const std::string& file, std::string_view bytes,
                                                      document::Problems& problems);

}  // namespace softgrip::sysid
