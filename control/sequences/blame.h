#pragma once
// Reports each problem of a sequence at the parameter whose value causes the problem.

#include <functional>
#include <span>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::control {

/// A function that reads a sequence with given values of its parameters and returns the problems of the
/// sequence.
using Judge = std::function<document::Problems(const std::vector<Parameter>& parameters)>;

/// Adds the problems that `judge` finds with the values of `parameters`. If the value of one parameter alone
/// causes a problem, the problem is reported at this parameter, and the message gives the line of the step.
/// If several values together cause the problem, or if the default values cause it too, the problem is
/// reported at the step.
void blame_values(const document::Document& document, const std::vector<Parameter>& parameters,
                  const Judge& judge, document::Problems& problems);

/// Tests both ends of the range of each parameter, while the other parameters have their defaults.
/// Combinations of values are not tested here, but at each start. Adds nothing if the defaults already have
/// problems.
void blame_ends(const document::Document& document, std::vector<Parameter> parameters, const Judge& judge,
                document::Problems& problems);

}  // namespace softgrip::control
