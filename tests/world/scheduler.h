#pragma once
// Runs the threads of a daemon as fibres on one simulated clock. One fibre runs at a time, and the seed alone
// determines the order of the fibres. A fibre can be paused while it sleeps, or immediately after it has read
// the clock.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "tests/world/fibre.h"

namespace softgrip::world {

using ActorId = std::size_t;

class Scheduler {
 public:
  explicit Scheduler(std::uint64_t seed, Nanoseconds begin) : seed_(seed), now_(begin) {}

  /// Adds a simulated thread (actor), which starts at the present time.
  ActorId add(std::string name, std::function<void()> body);
  /// Ends the simulated thread immediately. The thread never continues.
  void kill(ActorId actor);
  [[nodiscard]] bool done(ActorId actor) const { return actors_[actor].over; }

  /// Pauses the simulated thread until the time `until`.
  void pause(ActorId actor, Nanoseconds until);
  /// Pauses the simulated thread for `duration` immediately after its next reading of the clock. The thread
  /// then continues with an outdated time.
  void pause_after_look(ActorId actor, Nanoseconds duration) { actors_[actor].pause_after_look = duration; }
  [[nodiscard]] bool paused(ActorId actor) const;
  /// Ends the sleep of a simulated thread, because the awaited event has occurred.
  void wake(ActorId actor);

  /// Runs all simulated threads whose wake-up time is not later than `end`. Calls `after` with the id of a
  /// thread each time this thread begins to sleep.
  void run_until(Nanoseconds end, const std::function<void(ActorId)>& after);
  void stop() noexcept { stopped_ = true; }

  [[nodiscard]] Nanoseconds now() const noexcept { return now_; }

  /// Stops the clock of the daemon for `duration`. Afterwards, the clock shows the true time. During the
  /// stall, threads that sleep by this clock continue to sleep, and paused threads remain paused. If a paused
  /// thread could continue during the stall, the clock would show the daemon a shorter pause. On a board
  /// where any write clears a watchdog trip, the daemon could then not detect the pause. A second stall
  /// during a stall has no effect.
  void stall_clock(Nanoseconds duration);
  [[nodiscard]] bool clock_stalled() const noexcept { return now_ < stall_ends_; }
  /// Returns the time on the clock of the daemon.
  [[nodiscard]] Nanoseconds shown() const noexcept { return clock_stalled() ? stall_shows_ : now_; }
  /// Sleeps until the clock of the daemon shows the time `due`. Called by a simulated thread.
  void sleep_until_shown(Nanoseconds due);

  /// Sleeps until the true time `due` plus a random delay, as in the kernel. Called by a simulated thread.
  void sleep_until(Nanoseconds due);
  /// Called by a simulated thread immediately after it has read the clock.
  void looked();

 private:
  [[nodiscard]] Nanoseconds end_of_pause(Nanoseconds until) const;

  struct Actor {
    std::string name;
    std::unique_ptr<Fibre> fibre;
    Nanoseconds due = 0;
    Nanoseconds paused_until = 0;
    Nanoseconds pause_after_look = 0;
    bool by_clock = false;  // true: the thread sleeps by the daemon's clock; false: it sleeps by the true
                            // time
    bool over = false;

    [[nodiscard]] Nanoseconds goes_on() const noexcept { return due > paused_until ? due : paused_until; }
  };
  [[nodiscard]] Actor* next();

  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  Nanoseconds now_;
  Nanoseconds stall_ends_ = 0;
  Nanoseconds stall_shows_ = 0;
  std::vector<Actor> actors_;
  ActorId running_ = 0;
  bool inside_ = false;
  bool stopped_ = false;
};

/// The daemon's clock in the simulated world.
class WorldClock : public Clock {
 public:
  explicit WorldClock(Scheduler& scheduler) : scheduler_(scheduler) {}
  [[nodiscard]] Nanoseconds now() const noexcept override {
    const Nanoseconds seen = scheduler_.shown();
    if (std::exchange(slept_, false)) woke_ = seen;
    scheduler_.looked();
    return seen;
  }
  void sleep_until(Nanoseconds due) const noexcept override {
    scheduler_.sleep_until_shown(due);
    slept_ = true;
  }
  /// Returns the first time that the thread read from the clock after its last sleep.
  [[nodiscard]] Nanoseconds woke() const noexcept { return woke_; }

 private:
  Scheduler& scheduler_;
  mutable Nanoseconds woke_ = 0;
  mutable bool slept_ = false;
};

}  // namespace softgrip::world
