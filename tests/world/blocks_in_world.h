#pragma once
// Clients of the daemon that start a sequence in a block and stop this start when they leave the block. The
// Python client and `softgrip start` follow the same protocol.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_blocks(Host& host);

}  // namespace softgrip::world
