#pragma once
// Runs one sequence from start to end without a client: for `softgripd --sequence` and `softgrip run`.

#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/recording/sequence_store.h"
#include "daemon/socket/service.h"

namespace softgrip::daemon {

/// Waits until the rig is idle, starts the sequence, and waits until 1 s after the end of the sequence. If
/// the rig is still stopping then, also waits until it is idle or faulted.
class OneShotRun {
 public:
  enum class State : std::uint8_t {
    waiting,          ///< the run waits until the rig is idle
    start_requested,  ///< the start request was passed to the loop
    running,
    ended,
    refused,   ///< the rig was in a state in which a sequence must not start; refusal() gives the reason
    not_idle,  ///< the rig did not become idle in time
  };

  /// `idle_timeout` is the longest time to wait until the rig is idle [ns].
  OneShotRun(std::shared_ptr<const LoadedSequence> sequence, Nanoseconds idle_timeout);

  /// Performs the next action if it is due. The thread that calls Service must call this function after each
  /// Service::pump().
  void step(Service& service, Nanoseconds now);

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool finished() const noexcept { return state_ >= State::ended; }
  [[nodiscard]] control::RefusalCode refusal() const noexcept { return refusal_; }
  /// Returns how the sequence ended; nothing if the sequence has not ended yet.
  [[nodiscard]] std::optional<control::SequenceEnd> end() const noexcept { return end_; }

 private:
  std::shared_ptr<const LoadedSequence> sequence_;
  Nanoseconds idle_timeout_;
  Nanoseconds began_ = -1;
  Nanoseconds ended_ = 0;
  State state_ = State::waiting;
  std::uint32_t request_ = 0;
  control::RefusalCode refusal_ = control::RefusalCode::none;
  std::optional<control::SequenceEnd> end_;
};

}  // namespace softgrip::daemon
