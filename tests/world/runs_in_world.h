#pragma once
// Simulated commands that run the daemon in their own process, once for each sequence.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

/// Returns a guest that calls `softgrip run` repeatedly.
[[nodiscard]] std::unique_ptr<Guest> make_run(Host& host);
/// Returns a guest that calls `softgrip baseline` with one experiment. The rests before the experiment are
/// omitted.
[[nodiscard]] std::unique_ptr<Guest> make_baseline(Host& host);
/// Returns a guest that plays one experiment after the other, as `softgrip investigate` does. The diagnosis
/// is omitted, because it moves no finger.
[[nodiscard]] std::unique_ptr<Guest> make_experiment(Host& host);

}  // namespace softgrip::world
