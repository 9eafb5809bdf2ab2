#pragma once
// Simulates clients that start a sequence at the beginning of a block of their program and stop the sequence
// at the end of the block. A `with` statement of Python works in this way. The Python client and `softgrip
// start` send the same requests.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_blocks(Host& host);

}  // namespace softgrip::world
