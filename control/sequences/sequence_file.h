#pragma once
// Reads a Sequence from a YAML file. The file format is described in docs/reference/sequence-file.md.

#include <optional>
#include <span>
#include <string>

#include "control/tick/sequence.h"
#include "document/node.h"

namespace softgrip::control {

/// Reads a sequence from a parsed document. The values in `arguments` come from a start request; they replace
/// the defaults of the parameters. Adds all errors to `problems` and returns nullopt if there are errors or
/// if a part of the document could not be parsed. The sequence must be valid with its defaults, at both ends
/// of each parameter's range and with the requested values.
[[nodiscard]] std::optional<Sequence> read_sequence(const document::Document& document,
                                                    document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads a file with parse_file() and read_sequence().
[[nodiscard]] std::optional<Sequence> load_sequence(const std::string& path, document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads the sequence from the same document with other values of its parameters. Adds the problems of these
/// values to `problems`.
[[nodiscard]] std::optional<Sequence> read_with(const document::Document& document,
                                                const std::vector<Parameter>& parameters,
                                                document::Problems& problems);

}  // namespace softgrip::control
