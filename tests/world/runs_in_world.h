#pragma once
// Simulated commands that run the daemon in their own process, once for each sequence.

#include <memory>

#include "tests/world/guest.h"

namespace softgrip::world {

/// Returns a guest that calls `softgrip run` repeatedly.
[[nodiscard]] std::unique_ptr<Guest> make_run(Host& host);
/// Returns a guest that calls `softgrip baseline` with one experiment and without the pauses before the
/// experiment.
[[nodiscard]] std::unique_ptr<Guest> make_baseline(Host& host);
/// Returns a guest that plays one experiment after another, as `softgrip investigate` does. The diagnosis
/// moves no finger, so it is omitted.
[[nodiscard]] std::unique_ptr<Guest> make_experiment(Host& host);

}  // namespace softgrip::world
