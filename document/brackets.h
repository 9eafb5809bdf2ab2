#pragma once
// Which brackets of a text are open at a place: for messages about those that are never closed.

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

/// Those that are open before `place`, the innermost last. Brackets in quotes, comments, folded texts and in
/// the middle of plain texts open nothing. One that is closed by the other kind counts as open.
[[nodiscard]] std::vector<Bracket> open_brackets(std::string_view text, Location place);

}  // namespace softgrip::document
