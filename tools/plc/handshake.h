#pragma once
// Counters by which a command is carried out once.

#include <cstdint>
#include <optional>

#include "tools/plc/codes.h"

namespace softgrip::plc {

/// The master counts its commands: a counter that differs from the last one is a new command, the same one
/// never is, however often it is written. The first counter after the gateway's start is only taken note of:
/// nobody knows whether the gateway before this one carried it out. A counter without a command is where a
/// master begins to count.
class Handshake {
 public:
  /// The master has written the counter. True: the command is to be carried out now.
  [[nodiscard]] bool write(std::uint16_t counter, CommandCode command) noexcept;
  /// A command came to an end. One that another has overtaken since is over without a word.
  void finish(std::uint16_t counter, Outcome outcome, Reason reason = Reason::none) noexcept;
  /// The daemon has gone: what is under way will not be answered.
  void lose() noexcept;

  /// A counter was seen.
  [[nodiscard]] bool synchronised() const noexcept { return done_.has_value(); }
  [[nodiscard]] std::uint16_t done_counter() const noexcept { return done_.value_or(0); }
  [[nodiscard]] Outcome outcome() const noexcept { return executing_ ? Outcome::executing : outcome_; }
  [[nodiscard]] Reason reason() const noexcept { return reason_; }

 private:
  std::optional<std::uint16_t> done_;
  std::optional<std::uint16_t> executing_;
  Outcome outcome_ = Outcome::none;
  Reason reason_ = Reason::none;
};

}  // namespace softgrip::plc
