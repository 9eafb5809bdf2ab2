#pragma once
// Reports each problem of a sequence at the parameter whose value causes this problem.

#include <functional>
#include <span>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::control {

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
