#pragma once
// The threads of a daemon as fibres on one simulated clock: one of them runs at a time, which one follows
// from the seed alone. Any can be paused while it sleeps, or right after it has looked at the clock.

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

  /// A thread that begins now.
  ActorId add(std::string name, std::function<void()> body);
  /// It never goes on.
  void kill(ActorId actor);
  [[nodiscard]] bool done(ActorId actor) const { return actors_[actor].over; }

  /// It does not go on before `until`.
  void pause(ActorId actor, Nanoseconds until);
  /// It stands still for `duration` after it has looked at the clock the next time: what it knows is old.
  void pause_after_look(ActorId actor, Nanoseconds duration) { actors_[actor].pause_after_look = duration; }
  [[nodiscard]] bool paused(ActorId actor) const;
  /// What it waits for has come.
  void wake(ActorId actor);

  /// Runs whoever is due, up to and with `end`. `after` is told who ran, whenever one sleeps again.
  void run_until(Nanoseconds end, const std::function<void(ActorId)>& after);
  void stop() noexcept { stopped_ = true; }

  [[nodiscard]] Nanoseconds now() const noexcept { return now_; }

  /// The daemon's clock stands still for `duration`, then it catches up. Who sleeps by it sleeps on, and who
  /// is paused does not go on before: by a clock that stands a long pause looks short, and of a board that
  /// clears its tripped watchdog with any write nobody could know better. Another stall meanwhile is none.
  void stall_clock(Nanoseconds duration);
  [[nodiscard]] bool clock_stalled() const noexcept { return now_ < stall_ends_; }
  /// What that clock shows.
  [[nodiscard]] Nanoseconds shown() const noexcept { return clock_stalled() ? stall_shows_ : now_; }
  /// From within an actor: until that clock shows `due`.
  void sleep_until_shown(Nanoseconds due);

  /// From within an actor. A sleep ends a little late, as the kernel's do.
  void sleep_until(Nanoseconds due);
  /// From within an actor, which has just looked at the clock.
  void looked();

 private:
  [[nodiscard]] Nanoseconds end_of_pause(Nanoseconds until) const;

  struct Actor {
    std::string name;
    std::unique_ptr<Fibre> fibre;
    Nanoseconds due = 0;
    Nanoseconds paused_until = 0;
    Nanoseconds pause_after_look = 0;
    bool by_clock = false;  // it sleeps by the daemon's clock
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

/// The clock of the daemon in the world.
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
  /// What it showed at the first look after the last sleep.
  [[nodiscard]] Nanoseconds woke() const noexcept { return woke_; }

 private:
  Scheduler& scheduler_;
  mutable Nanoseconds woke_ = 0;
  mutable bool slept_ = false;
};

}  // namespace softgrip::world
