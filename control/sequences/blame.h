#pragma once
// Reports problems at the parameter whose value causes them.

#include <functional>
#include <span>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::control {

/// Returns the problems of a sequence that is read with these values.
using Judge = std::function<document::Problems(const std::vector<Parameter>& parameters)>;

/// Adds the problems that `judge` finds with these values. A problem is reported at the parameter if its
/// value alone causes it, with the step's line in the message. It is reported at the step if several values
/// cause it, or if the defaults have it too.
void blame_values(const document::Document& document, const std::vector<Parameter>& parameters,
                  const Judge& judge, document::Problems& problems);

/// Tests both ends of each range, one parameter at a time, with the others at their defaults. The start
/// checks combinations of values. Adds nothing if the defaults are already wrong.
void blame_ends(const document::Document& document, std::vector<Parameter> parameters, const Judge& judge,
                document::Problems& problems);

}  // namespace softgrip::control
