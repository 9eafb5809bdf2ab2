#pragma once
// Functions that test single components of the simulated worlds. They print the results as tables on the
// standard output.

#include <string>

namespace textbook {

/// Runs the test with this name: flow, rest, hold, loops, relays, span or creep. Throws std::invalid_argument
/// for any other name.
void probe(const std::string& name);

}  // namespace textbook
