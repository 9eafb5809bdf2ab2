#pragma once
// What a test asks of a part alone: tables on the standard output.

#include <string>

namespace textbook {

/// flow, rest, hold, loops, relays, span or creep; throws std::invalid_argument for anything else.
void probe(const std::string& name);

}  // namespace textbook
