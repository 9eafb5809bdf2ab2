#pragma once
// Simulates softgrip-plc (the gateway), two masters, and the register blocks that travel between gateway and
// masters. The daemon runs in the same world.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_plc(Host& host);

}  // namespace softgrip::world
