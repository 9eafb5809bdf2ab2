#pragma once
// Checks the text of a document before the YAML parser reads it.

#include "document/node.h"

namespace softgrip::document {

/// Checks size, UTF-8, byte order mark, control characters, tabs in the indentation and directives. Adds each
/// problem to `problems`. Returns false if the text must not be parsed.
[[nodiscard]] bool check_text(const Document& document, const Bounds& bounds, Problems& problems);

}  // namespace softgrip::document
