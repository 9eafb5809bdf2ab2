#pragma once
// Reads `parameters:` of a sequence file, assigns their values, and inserts these into the steps.

#include <span>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::control {

/// Returns the parameters that a document declares, each with its default as its value. Errors of a parameter
/// are added to `problems`; the other parameters are still read.
[[nodiscard]] std::vector<Parameter> read_parameters(const document::Document& document,
                                                     document::Problems& problems);

/// Assigns the values that a start request gives to the parameters. An unknown name, a repeated name and a
/// value out of range are problems. They are reported at the parameter, or at the top of the document.
void set_values(std::span<const Argument> arguments, const document::Document& document,
                std::vector<Parameter>& parameters, document::Problems& problems);

/// Returns the document with each `$name` below `steps` replaced by the value of that parameter. Problems: an
/// unknown name, a key with another unit, and a parameter that no step uses.
[[nodiscard]] document::Document with_values(const document::Document& document,
                                             const std::vector<Parameter>& parameters,
                                             document::Problems& problems);

}  // namespace softgrip::control
