#include "daemon/panel/trip_input.h"

#include <algorithm>

namespace softgrip::daemon {

void TripInput::settle(Nanoseconds now) noexcept {
  if (!known_) return;
  const bool steady = now - since_ >= debounce_;
  if (steady && !asks_) {
    tripped_ = false;
    suspect_ = never;
  } else if ((steady && asks_) || (suspect_ != never && now - suspect_ >= 2 * debounce_)) {
    tripped_ = true;
  }
}

void TripInput::change(bool trips, Nanoseconds at) noexcept {
  known_ = true;
  asks_ = trips;
  since_ = at;
  // Stores the time of the first edge since the line was last steady, for edges in both directions. A line
  // that is clear now may have been at its trip level, because the edge to the trip level can be lost.
  if (suspect_ == never) suspect_ = at;
}

void TripInput::edge(bool trips, Nanoseconds at) noexcept {
  // If the level was read after this edge occurred, the change of level that the edge reports is already
  // known.
  if (known_ && at <= since_) {
    if (trips != asks_) change(trips, since_);
    return;
  }
  settle(at);
  change(trips, at);
}

void TripInput::level(bool trips, Nanoseconds now) noexcept {
  if (!known_ || trips != asks_) {
    settle(now);
    change(trips, now);
  }
  settle(now);
}

Nanoseconds TripInput::due() const noexcept {
  if (!known_) return 0;
  const bool pending = asks_ != tripped_ || (!tripped_ && suspect_ != never);
  if (!pending) return never;
  Nanoseconds next = since_ + debounce_;
  if (!tripped_ && suspect_ != never) next = std::min(next, suspect_ + 2 * debounce_);
  return next;
}

}  // namespace softgrip::daemon
