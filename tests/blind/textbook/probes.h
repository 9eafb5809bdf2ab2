#pragma once
// Tests of single parts, which print tables on the standard output.

#include <string>

namespace textbook {

/// `name` is flow, rest, hold, loops, relays, span or creep. Throws std::invalid_argument for any other name.
void probe(const std::string& name);

}  // namespace textbook
