#pragma once
// Finds the brackets that are open at a location of a text. Messages about unclosed brackets use this
// function.

#include <cstddef>
#include <string_view>
#include <vector>

#include "document/problem.h"

namespace softgrip::document {

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
