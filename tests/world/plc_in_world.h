#pragma once
// Simulates softgrip-plc (the gateway), two masters, and the register blocks that they exchange with the
// gateway. The daemon runs in the same simulated world.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_plc(Host& host);

}  // namespace softgrip::world
