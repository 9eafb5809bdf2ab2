#pragma once
// Board files: YAML to BoardMap. Strict; all problems at once.

#include <optional>
#include <string>

#include "document/node.h"
#include "drivers/board/board_map.h"

namespace softgrip::rig {

/// Reads a board map out of a parsed document. All errors are added to `problems`; nothing is returned then.
[[nodiscard]] std::optional<drivers::BoardMap> read_board_map(const document::Document& document,
                                                              document::Problems& problems);

/// parse_file() and read_board_map().
[[nodiscard]] std::optional<drivers::BoardMap> load_board_map(const std::string& path,
                                                              document::Problems& problems);

}  // namespace softgrip::rig
