#pragma once
// Simulates clients that start a sequence at the beginning of a block of their program and stop it at the end
// of the block, like a `with` statement of Python. The Python client and `softgrip start` use the same
// requests.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_blocks(Host& host);

}  // namespace softgrip::world
