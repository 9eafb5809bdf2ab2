#pragma once
// Simulates commands that run the daemon in their own process, once for each sequence.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

/// Returns a guest program that calls `softgrip run` repeatedly.
[[nodiscard]] std::unique_ptr<Guest> make_run(Host& host);
/// Returns a guest program that calls `softgrip baseline` with one experiment. The program omits the rests
/// before the experiment.
[[nodiscard]] std::unique_ptr<Guest> make_baseline(Host& host);
/// Returns a guest program that plays one experiment after the other, as `softgrip investigate` does. The
/// program omits the diagnosis, because the diagnosis moves no finger.
[[nodiscard]] std::unique_ptr<Guest> make_experiment(Host& host);

}  // namespace softgrip::world
