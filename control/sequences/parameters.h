#pragma once
// `parameters:` of a sequence file: read, given their values, put into the steps.

#include <span>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::control {

/// The parameters that a document declares, each with its default as its value. What is wrong with one is
/// added to `problems` and the others are read all the same.
[[nodiscard]] std::vector<Parameter> read_parameters(const document::Document& document,
                                                     document::Problems& problems);

/// Gives the parameters the values that a start asks for. A name that none has, one that comes twice and a
/// value out of its range are problems at the parameter, or at the top of the document.
void set_values(std::span<const Argument> arguments, const document::Document& document,
                std::vector<Parameter>& parameters, document::Problems& problems);

/// The document with every `$name` below `steps` replaced by the value of that parameter. Problems: a name
/// that no parameter has, a key whose unit is another one, a parameter that no step uses.
[[nodiscard]] document::Document with_values(const document::Document& document,
                                             const std::vector<Parameter>& parameters,
                                             document::Problems& problems);

}  // namespace softgrip::control
