#pragma once
// softgrip-plc and the daemon in one world: the gateway, two masters, and their blocks under way.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

[[nodiscard]] std::unique_ptr<Guest> make_plc(Host& host);

}  // namespace softgrip::world
