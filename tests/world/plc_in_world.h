#pragma once
// softgrip-plc and the daemon in one simulated world, with the gateway, two masters, and the register blocks
// that they have sent.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_plc(Host& host);

}  // namespace softgrip::world
