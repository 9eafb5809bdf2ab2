#pragma once
// Reads a Sequence from a YAML file. The file format is described in docs/reference/sequence-file.md.

#include <optional>
#include <span>
#include <string>

#include "control/tick/sequence.h"
#include "document/node.h"

namespace softgrip::control {

/// Reads a sequence from a parsed document. The values in `arguments` come from a start request and replace
/// the defaults of the parameters. Adds all errors to `problems`. Returns nullopt if there are errors, or if
/// a part of the document could not be parsed. The sequence must be valid with its defaults, at both ends of
/// each parameter's range and with the values in `arguments`.
[[nodiscard]] std::optional<Sequence> read_sequence(const document::Document& document,
                                                    document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads a file with parse_file() and read_sequence().
[[nodiscard]] std::optional<Sequence> load_sequence(const std::string& path, document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads the sequence of a document with the values in `parameters`. Adds the problems that these values
/// cause to `problems`.
[[nodiscard]] std::optional<Sequence> read_with(const document::Document& document,
                                                const std::vector<Parameter>& parameters,
                                                document::Problems& problems);

}  // namespace softgrip::control
