#pragma once
// Explains the syntax errors that the YAML parser reports.
// Checks the text of a document before the YAML parser reads it.
// Finds the brackets that are open at a location of a text. Messages about unclosed brackets use this
// function.

#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"
#include "document/problem.h"

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

/// Checks size, UTF-8, byte order mark, control characters, tabs in the indentation and directives. Adds each
/// problem to `problems`. Returns false if the text must not be parsed.
[[nodiscard]] bool check_text(const Document& document, const Bounds& bounds, Problems& problems);

/// A `[` or `{` that opens a list or a map.
struct Bracket {
  char character = '[';
  Location at;
};

/// Returns the brackets that are open before `place`, the innermost bracket last. Brackets in quotes,
/// comments, folded texts and in the middle of plain texts are ignored. A closing bracket does not close a
/// bracket of the other type: in `[1}`, the `[` is still open.
[[nodiscard]] std::vector<Bracket> open_brackets(std::string_view text, Location place);

}  // namespace softgrip::document
