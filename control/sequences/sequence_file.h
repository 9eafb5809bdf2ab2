#pragma once
// Sequence files: YAML to Sequence. The file format is described in docs/reference/sequence-file.md.

#include <optional>
#include <span>
#include <string>

#include "control/tick/sequence.h"
#include "document/node.h"

namespace softgrip::control {

/// Reads a sequence out of a parsed document, with the values that a start asks for in the place of its
/// parameters' defaults. All errors are added to `problems`; nothing is returned then, nor when parsing had
/// refused a part of the document. The sequence must be sound with its defaults, at both ends of each
/// parameter's range and with the values asked for.
[[nodiscard]] std::optional<Sequence> read_sequence(const document::Document& document,
                                                    document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// parse_file() and read_sequence().
[[nodiscard]] std::optional<Sequence> load_sequence(const std::string& path, document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads it once more with other values of its parameters; what is wrong with it then is added to `problems`.
[[nodiscard]] std::optional<Sequence> read_with(const document::Document& document,
                                                const std::vector<Parameter>& parameters,
                                                document::Problems& problems);

}  // namespace softgrip::control
