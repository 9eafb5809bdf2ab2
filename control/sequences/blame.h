#pragma once
// Problems that come from the value of a parameter are told at the parameter.

#include <functional>
#include <span>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::control {

/// What is wrong with a sequence, read with these values.
using Judge = std::function<document::Problems(const std::vector<Parameter>& parameters)>;

/// Adds what `judge` finds with these values, each at the line of the parameter whose value alone is enough
/// for it, with the step's line in the message; at the step itself where it takes several, or where the
/// defaults are no better. Nothing is added where `judge` finds nothing.
void blame_values(const document::Document& document, const std::vector<Parameter>& parameters,
                  const Judge& judge, document::Problems& problems);

/// The same at both ends of each range, one parameter after the other, the others at their defaults: what
/// goes together is for the start to judge. Nothing is added where the defaults are wrong already.
void blame_ends(const document::Document& document, std::vector<Parameter> parameters, const Judge& judge,
                document::Problems& problems);

}  // namespace softgrip::control
