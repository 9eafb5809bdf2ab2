#pragma once
// Tests single components of the simulated worlds and prints the results as tables on the standard output.

#include <string>

namespace textbook {

/// Runs the test `name`: flow, rest, hold, loops, relays, span or creep. Throws std::invalid_argument for any
/// other name.
void probe(const std::string& name);

}  // namespace textbook
