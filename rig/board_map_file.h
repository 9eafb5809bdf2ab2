#pragma once
// Reads board files (YAML) into a BoardMap. Unknown keys are errors. All problems of a file are reported
// together.

#include <optional>
#include <string>

#include "document/node.h"
#include "drivers/board/board_map.h"

namespace softgrip::rig {

/// Reads a board map from a parsed document. Adds all errors to `problems`, and returns nothing if there are
/// errors.
[[nodiscard]] std::optional<drivers::BoardMap> read_board_map(const document::Document& document,
                                                              document::Problems& problems);

/// Reads a board map from a file, with parse_file() and read_board_map().
[[nodiscard]] std::optional<drivers::BoardMap> load_board_map(const std::string& path,
                                                              document::Problems& problems);

}  // namespace softgrip::rig
