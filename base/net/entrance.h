#pragma once
// Accepts clients at a listening socket, even if the process has no free descriptor.

#include <array>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::net {

/// Accepts clients. If no descriptor is free, a waiting client cannot be accepted, and each poll() returns at
/// once. The server would then use a complete processor core. Therefore, the listener pauses. Before the
/// pause, it closes its spare descriptors and accepts one more client, because this client may be the one
/// that stops the rig.
class Entrance {
 public:
  /// Duration of the pause until the listener tries again [ns].
  static constexpr Nanoseconds rest = ns_per_s / 10;

  Entrance() = default;
  /// @param listener  a socket from listen_tcp() or listen_unix(); if it is empty, no client is accepted.
  explicit Entrance(Descriptor listener);

  /// Returns the descriptor for poll(); -1 while the listener pauses.
  [[nodiscard]] int descriptor(Nanoseconds now) const noexcept {
    return now < rests_until_ ? -1 : listener_.get();
  }
  /// Returns the next client, as accept_client() does. Returns an empty descriptor if no client waits, or if
  /// no client can be accepted.
  [[nodiscard]] Descriptor accept(Nanoseconds now);
  /// Returns true if the last accept() found no free descriptor. In this case, the caller should close
  /// descriptors that it does not need.
  [[nodiscard]] bool short_of_descriptors() const noexcept { return short_; }

 private:
  void take_spares() noexcept;

  Descriptor listener_;
  /// Reserved descriptors: one for a client, and one that the request of this client may need.
  std::array<Descriptor, 2> spares_;
  Nanoseconds rests_until_ = 0;
  bool short_ = false;
};

}  // namespace softgrip::net
