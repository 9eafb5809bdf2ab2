#pragma once
// Runs the threads of a daemon as fibres on one simulated clock. One fibre runs at a time. The order of the
// fibres depends only on the seed. A fibre can be paused while it sleeps, or immediately after it has read
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

  /// Adds a thread, which starts at the present time.
  ActorId add(std::string name, std::function<void()> body);
  /// Ends the actor. It never runs again.
  void kill(ActorId actor);
  [[nodiscard]] bool done(ActorId actor) const { return actors_[actor].over; }

  /// Pauses the actor until the time `until`.
  void pause(ActorId actor, Nanoseconds until);
  /// Pauses the actor for `duration` immediately after it has next read the clock, so that it continues with
  /// an outdated time.
  void pause_after_look(ActorId actor, Nanoseconds duration) { actors_[actor].pause_after_look = duration; }
  [[nodiscard]] bool paused(ActorId actor) const;
  /// Ends the sleep of an actor, because the event for which it waits has occurred.
  void wake(ActorId actor);

  /// Runs all actors whose time is not later than `end`. Each time an actor goes to sleep, calls `after` with
  /// its id.
  void run_until(Nanoseconds end, const std::function<void(ActorId)>& after);
  void stop() noexcept { stopped_ = true; }

  [[nodiscard]] Nanoseconds now() const noexcept { return now_; }

  /// Stops the daemon's clock for `duration`, after which the clock shows the true time. Actors that sleep by
  /// this clock continue to sleep, and paused actors remain paused. If paused actors ran during a stall, a
  /// long pause would look short to the daemon, and a board whose watchdog trip is cleared by any write could
  /// not reveal the pause. A stall during another stall has no effect.
  void stall_clock(Nanoseconds duration);
  [[nodiscard]] bool clock_stalled() const noexcept { return now_ < stall_ends_; }
  /// Returns the time that the daemon's clock shows.
  [[nodiscard]] Nanoseconds shown() const noexcept { return clock_stalled() ? stall_shows_ : now_; }
  /// Sleeps until the daemon's clock shows the time `due`. Called by an actor.
  void sleep_until_shown(Nanoseconds due);

  /// Sleeps until the time `due` plus a random delay, as in the kernel. Called by an actor.
  void sleep_until(Nanoseconds due);
  /// Called by an actor immediately after it has read the clock.
  void looked();

 private:
  [[nodiscard]] Nanoseconds end_of_pause(Nanoseconds until) const;

  struct Actor {
    std::string name;
    std::unique_ptr<Fibre> fibre;
    Nanoseconds due = 0;
    Nanoseconds paused_until = 0;
    Nanoseconds pause_after_look = 0;
    bool by_clock = false;  // the actor sleeps until the daemon's clock, not the true time, reaches its time
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
  /// Returns the time of the first reading of the clock after the thread's last sleep.
  [[nodiscard]] Nanoseconds woke() const noexcept { return woke_; }

 private:
  Scheduler& scheduler_;
  mutable Nanoseconds woke_ = 0;
  mutable bool slept_ = false;
};

}  // namespace softgrip::world
