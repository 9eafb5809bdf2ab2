#include "tests/world/scheduler.h"

#include <algorithm>

#include "base/random.h"

namespace softgrip::world {
namespace {

/// Longest delay between the end of a sleep and the continuation of a simulated thread [ns]. Most delays are
/// much smaller.
constexpr double latest_wake_ns = 300'000;

}  // namespace

ActorId Scheduler::add(std::string name, std::function<void()> body) {
  Actor actor;
  actor.name = std::move(name);
  actor.fibre = std::make_unique<Fibre>(std::move(body));
  actor.due = now_;
  actors_.push_back(std::move(actor));
  return actors_.size() - 1;
}

void Scheduler::kill(ActorId actor) {
  actors_[actor].over = true;
}

void Scheduler::pause(ActorId actor, Nanoseconds until) {
  actors_[actor].paused_until = std::max(actors_[actor].paused_until, end_of_pause(until));
}

Nanoseconds Scheduler::end_of_pause(Nanoseconds until) const {
  return clock_stalled() ? std::max(until, stall_ends_) : until;
}

bool Scheduler::paused(ActorId actor) const {
  return actors_[actor].paused_until > now_;
}

void Scheduler::wake(ActorId actor) {
  actors_[actor].due = std::min(actors_[actor].due, now_);
}

Scheduler::Actor* Scheduler::next() {
  Actor* first = nullptr;
  for (Actor& actor : actors_) {
    if (actor.over) continue;
    if (first == nullptr || actor.goes_on() < first->goes_on()) first = &actor;
  }
  return first;
}

void Scheduler::run_until(Nanoseconds end, const std::function<void(ActorId)>& after) {
  while (!stopped_) {
    Actor* const actor = next();
    if (actor == nullptr || actor->goes_on() > end) break;
    now_ = std::max(now_, actor->goes_on());
    running_ = static_cast<ActorId>(actor - actors_.data());
    inside_ = true;
    actor->fibre->resume();
    inside_ = false;
    // The vector may have grown while the simulated thread ran, so read the reference to its entry a second
    // time.
    Actor& ran = actors_[running_];
    if (ran.fibre->done()) ran.over = true;
    after(running_);
  }
  now_ = std::max(now_, end);
}

void Scheduler::sleep_until(Nanoseconds due) {
  const double u = uniform_at(seed_, ++drawn_);
  Actor& self = actors_[running_];
  self.due = std::max(due, now_) + static_cast<Nanoseconds>(latest_wake_ns * u * u * u);
  Fibre& fibre = *self.fibre;
  fibre.give_back();
}

void Scheduler::stall_clock(Nanoseconds duration) {
  if (clock_stalled()) return;
  stall_shows_ = now_;
  stall_ends_ = now_ + duration;
  for (Actor& actor : actors_) {
    if (actor.paused_until > now_) actor.paused_until = end_of_pause(actor.paused_until);
    if (actor.by_clock && actor.due >= now_) actor.due = std::max(actor.due, stall_ends_);
  }
}

void Scheduler::sleep_until_shown(Nanoseconds due) {
  const ActorId self = running_;
  actors_[self].by_clock = true;
  sleep_until(clock_stalled() && due > stall_shows_ ? std::max(due, stall_ends_) : due);
  actors_[self].by_clock = false;
}

void Scheduler::looked() {
  if (!inside_) return;
  Actor& self = actors_[running_];
  if (self.pause_after_look == 0) return;
  self.due = now_;
  self.paused_until = std::max(self.paused_until, end_of_pause(now_ + self.pause_after_look));
  self.pause_after_look = 0;
  Fibre& fibre = *self.fibre;
  fibre.give_back();
}

}  // namespace softgrip::world
