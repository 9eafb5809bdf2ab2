#pragma once
// Runs one sequence from start to end without a user: `softgripd --sequence`, `softgrip run`.

#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/recording/sequence_store.h"
#include "daemon/socket/service.h"

namespace softgrip::daemon {

/// Waits until the rig is idle, starts the sequence, and waits until it has ended and the fingers are at
/// rest.
class OneShotRun {
 public:
  enum class State : std::uint8_t {
    waiting,  ///< waits until the rig is idle
    asked,    ///< the start was passed to the loop
    running,
    ended,
    refused,   ///< the state of the rig did not permit the start; see refusal()
    not_idle,  ///< the rig did not become idle in time
  };

  /// `patience`: longest wait for an idle rig [ns].
  OneShotRun(std::shared_ptr<const LoadedSequence> sequence, Nanoseconds patience);

  /// Performs the next action that is due. Must be called periodically by the thread that calls the service,
  /// after Service::pump().
  void step(Service& service, Nanoseconds now);

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool over() const noexcept { return state_ >= State::ended; }
  [[nodiscard]] control::RefusalCode refusal() const noexcept { return refusal_; }
  /// Returns the way in which the sequence ended; nothing before its end.
  [[nodiscard]] std::optional<control::SequenceEnd> end() const noexcept { return end_; }

 private:
  std::shared_ptr<const LoadedSequence> sequence_;
  Nanoseconds patience_;
  Nanoseconds began_ = -1;
  Nanoseconds ended_ = 0;
  State state_ = State::waiting;
  std::uint32_t request_ = 0;
  control::RefusalCode refusal_ = control::RefusalCode::none;
  std::optional<control::SequenceEnd> end_;
};

}  // namespace softgrip::daemon
