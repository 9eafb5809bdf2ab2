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

/// Adds what `judge` finds with these values, each at the line of the parameter whose value alone is enough
/// for it, with the step's line in the message; at the step itself where it takes several, or where the
/// defaults are no better. Nothing is added where `judge` finds nothing.
void blame_values(const document::Document& document, const std::vector<Parameter>& parameters,
                  const Judge& judge, document::Problems& problems);

/// Tests both ends of each range, one parameter at a time, with the others at their defaults. The start
/// checks combinations of values. Adds nothing if the defaults are already wrong.
void blame_ends(const document::Document& document, std::vector<Parameter> parameters, const Judge& judge,
                document::Problems& problems);

}  // namespace softgrip::control
