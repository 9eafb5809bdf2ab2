#pragma once
// Sequence files: YAML to Sequence. The file format is described in docs/reference/sequence-file.md.

#include <optional>
#include <string>

#include "control/tick/sequence.h"
#include "document/node.h"

namespace softgrip::control {

/// Reads a sequence out of a parsed document. All errors are added to `problems`; nothing is returned then,
/// nor when parsing had refused a part of the document.
[[nodiscard]] std::optional<Sequence> read_sequence(const document::Document& document,
                                                    document::Problems& problems);

/// parse_file() and read_sequence().
[[nodiscard]] std::optional<Sequence> load_sequence(const std::string& path, document::Problems& problems);

}  // namespace softgrip::control
