#pragma once
// Explains the syntax errors of the YAML parser.

#include <string>
#include <string_view>

#include "document/node.h"

namespace softgrip::document {

struct SyntaxMessage {
  std::string message;
  std::string hint;
};

/// @param said  the parser's own message
/// @param open  the innermost map or sequence that was being read, or nullptr
/// @param at    where the parser stopped
[[nodiscard]] SyntaxMessage syntax_message(const Document& document, std::string_view said, const Node* open,
                                           Location at);

/// The line with the number `line` (from 1) of a text, without its line break; empty beyond its end.
[[nodiscard]] std::string_view line_of(std::string_view text, int line);

}  // namespace softgrip::document
