#pragma once
// Accepts clients at a listening socket, also while the process has no free descriptor.

#include <array>

#include "base/descriptor.h"
#include "base/time.h"

namespace softgrip::modbus {

/// A client that waits in the queue of a listener keeps poll() from waiting. If the client cannot be accepted
/// because no descriptor is free, a server that only tries again uses a whole processor. Therefore the
/// listener rests for a moment. Before it rests, it gives up its spare descriptors, so that one client that
/// wants to stop the rig is served.
class Entrance {
 public:
  /// Time until the next attempt.
  static constexpr Nanoseconds rest = ns_per_s / 10;

  Entrance() = default;
  /// @param listener  of listen_tcp() or listen_unix(); may be empty: then no client comes.
  explicit Entrance(Descriptor listener);

  /// Returns the descriptor for poll(), or -1 while the listener rests.
  [[nodiscard]] int descriptor(Nanoseconds now) const noexcept {
    return now < rests_until_ ? -1 : listener_.get();
  }
  /// Returns the next client as accept_client() does; empty if no client waits or none can be
  /// accepted.
  [[nodiscard]] Descriptor accept(Nanoseconds now);
  /// True if the last accept() found no free descriptor. The caller should close what it can.
  [[nodiscard]] bool short_of_descriptors() const noexcept { return short_; }

 private:
  void take_spares() noexcept;

  Descriptor listener_;
  /// One for the client, one for what its request needs.
  std::array<Descriptor, 2> spares_;
  Nanoseconds rests_until_ = 0;
  bool short_ = false;
};

}  // namespace softgrip::modbus
