#pragma once
// Simulates clients that start a sequence at the beginning of a program block and stop it at the end of the
// block, like a `with` statement of Python. The Python client and `softgrip start` follow the same protocol.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_blocks(Host& host);

}  // namespace softgrip::world
