#pragma once
// The characters of a foreign text.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"

namespace softgrip::sysid {

/// UTF-8 without a byte order mark, of UTF-8, UTF-16 with a byte order mark, or Latin-1; lines end with \n.
/// What is no text is a sentence that says so.
[[nodiscard]] tl::expected<std::string, std::string> utf8_of(std::string_view bytes);

struct ForeignText {
  std::string text;                ///< see utf8_of()
  std::vector<std::string> notes;  ///< NUL bytes at the end, as a logger leaves them that loses its power
};

/// The text of an external file with at most most_text_bytes and most_rows lines of at most longest_line
/// (table.h). A text that is refused is a problem.
[[nodiscard]] std::optional<ForeignText> foreign_text(const std::string& file, std::string_view bytes,
                                                      document::Problems& problems);

}  // namespace softgrip::sysid
