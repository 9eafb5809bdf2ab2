#pragma once
// Reads `parameters:` of a sequence file, assigns values to the parameters, and inserts the values into the
// steps.
// Reports each problem of a sequence at the parameter whose value causes this problem.

#include <functional>
#include <span>
#include <vector>

#include "control/tick/sequence.h"
#include "document/node.h"

namespace softgrip::control {

/// Returns the parameters that a document declares. The value of each parameter is its default. An error of
/// one parameter is added to `problems`, and the next parameters are read nevertheless.
[[nodiscard]] std::vector<Parameter> read_parameters(const document::Document& document,
                                                     document::Problems& problems);

/// Assigns the values of a start request to the parameters. An unknown name, a repeated name and a value
/// outside the range of its parameter are problems. A problem is reported at the parameter. If the name is
/// unknown, the problem is reported at the key `parameters`.
void set_values(std::span<const Argument> arguments, const document::Document& document,
                std::vector<Parameter>& parameters, document::Problems& problems);

/// Returns the document with each `$name` below `steps` replaced by the value of the parameter `name`. Adds a
/// problem for an unknown name, for a key with a unit that differs from the parameter's unit, and for a
/// parameter that no step uses.
[[nodiscard]] document::Document with_values(const document::Document& document,
                                             const std::vector<Parameter>& parameters,
                                             document::Problems& problems);

/// A function that reads a sequence with given values of its parameters and returns the problems that it
/// finds.
using Judge = std::function<document::Problems(const std::vector<Parameter>& parameters)>;

/// Adds the problems that `judge` finds with the values of `parameters`. A problem that the value of one
/// parameter alone causes is reported at this parameter, and the message gives the line of the step. A
/// problem that needs several values, or that exists with the default values too, is reported at the step.
void blame_values(const document::Document& document, const std::vector<Parameter>& parameters,
                  const Judge& judge, document::Problems& problems);

/// Tests the lowest and the highest value of each parameter, while all other parameters have their defaults.
/// Combinations of values are not tested here, but at each start of the sequence. Adds nothing to `problems`
/// if the sequence already has problems with all defaults.
void blame_ends(const document::Document& document, std::vector<Parameter> parameters, const Judge& judge,
                document::Problems& problems);

}  // namespace softgrip::control
