#pragma once
// Reads board files (YAML) into a BoardMap. Unknown keys are errors, and all problems are reported together.

#include <optional>
#include <string>

#include "document/node.h"
#include "drivers/board/board_map.h"

namespace softgrip::rig {

/// Reads a board map from a parsed document. Adds all errors to `problems`; returns nothing if there is an
/// error.
[[nodiscard]] std::optional<drivers::BoardMap> read_board_map(const document::Document& document,
                                                              document::Problems& problems);

/// Calls parse_file() and read_board_map().
[[nodiscard]] std::optional<drivers::BoardMap> load_board_map(const std::string& path,
                                                              document::Problems& problems);

}  // namespace softgrip::rig
