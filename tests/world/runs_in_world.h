#pragma once
// Commands that run the daemon in their own process for one sequence after the other.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

/// `softgrip run`, again and again.
[[nodiscard]] std::unique_ptr<Guest> make_run(Host& host);
/// `softgrip baseline`, of one experiment and without the rests before it.
[[nodiscard]] std::unique_ptr<Guest> make_baseline(Host& host);
/// One experiment after the other, as `softgrip investigate` plays them. The diagnosis
/// moves nothing and is left out.
[[nodiscard]] std::unique_ptr<Guest> make_experiment(Host& host);

}  // namespace softgrip::world
