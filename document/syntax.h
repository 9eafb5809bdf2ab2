#pragma once
// Explains the syntax errors that the YAML parser reports.

#include <string>
#include <string_view>

#include "document/node.h"

namespace softgrip::document {

struct SyntaxMessage {
  std::string message;
  std::string hint;
};

/// Returns the message and the hint for a syntax error.
/// @param said  the message of the parser
/// @param open  the innermost map or sequence that is not complete, or nullptr
/// @param at    the location at which the parser stopped
[[nodiscard]] SyntaxMessage syntax_message(const Document& document, std::string_view said, const Node* open,
                                           Location at);

/// Returns the line with the number `line` (from 1), without its line break. Returns an empty text if there
/// is no such line.
[[nodiscard]] std::string_view line_of(std::string_view text, int line);

}  // namespace softgrip::document
