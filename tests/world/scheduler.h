#pragma once
// Runs the threads of a daemon as fibres on one simulated clock. One fibre runs at a time, in an order that
// depends only on the seed. A fibre can be paused while it sleeps, or right after it has read the clock.

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

  /// Adds a thread that starts now.
  ActorId add(std::string name, std::function<void()> body);
  /// Ends the actor, which never runs again.
  void kill(ActorId actor);
  [[nodiscard]] bool done(ActorId actor) const { return actors_[actor].over; }

  /// Pauses the actor until the time `until`.
  void pause(ActorId actor, Nanoseconds until);
  /// Pauses the actor for `duration` after its next reading of the clock, so that this reading is out of
  /// date.
  void pause_after_look(ActorId actor, Nanoseconds duration) { actors_[actor].pause_after_look = duration; }
  [[nodiscard]] bool paused(ActorId actor) const;
  /// Ends the sleep of an actor because the awaited event has occurred.
  void wake(ActorId actor);

  /// Runs all due actors up to and including `end`. Calls `after` with the id of an actor each time it goes
  /// to sleep.
  void run_until(Nanoseconds end, const std::function<void(ActorId)>& after);
  void stop() noexcept { stopped_ = true; }

  [[nodiscard]] Nanoseconds now() const noexcept { return now_; }

  /// Stops the daemon's clock for `duration`, after which the clock catches up. Actors that sleep by this
  /// clock continue to sleep, and paused actors remain paused. Otherwise a long pause would look short to the
  /// daemon, and a board on which any write clears a watchdog trip could not reveal the pause. A stall during
  /// another stall has no effect.
  void stall_clock(Nanoseconds duration);
  [[nodiscard]] bool clock_stalled() const noexcept { return now_ < stall_ends_; }
  /// Returns the time that the daemon's clock shows.
  [[nodiscard]] Nanoseconds shown() const noexcept { return clock_stalled() ? stall_shows_ : now_; }
  /// Sleeps until the daemon's clock shows `due`. Called by an actor.
  void sleep_until_shown(Nanoseconds due);

  /// Sleeps until `due` and a little longer, like a sleep of the kernel. Called by an actor.
  void sleep_until(Nanoseconds due);
  /// Called by an actor that has just read the clock.
  void looked();

 private:
  [[nodiscard]] Nanoseconds end_of_pause(Nanoseconds until) const;

  struct Actor {
    std::string name;
    std::unique_ptr<Fibre> fibre;
    Nanoseconds due = 0;
    Nanoseconds paused_until = 0;
    Nanoseconds pause_after_look = 0;
    bool by_clock = false;  // the actor sleeps by the daemon's clock
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
  /// Returns the first time that was read after the last sleep.
  [[nodiscard]] Nanoseconds woke() const noexcept { return woke_; }

 private:
  Scheduler& scheduler_;
  mutable Nanoseconds woke_ = 0;
  mutable bool slept_ = false;
};

}  // namespace softgrip::world
