#pragma once
// Counters by which a command is executed at most once.

#include <cstdint>
#include <optional>

#include "tools/plc/codes.h"

namespace softgrip::plc {

/// A command as its registers hold it.
struct Command {
  std::uint16_t code = 0;  ///< a CommandCode, or a number that is none
  std::uint16_t recipe = 0;
  std::uint16_t squeeze = no_value;
  std::uint16_t speed = no_value;
  std::uint16_t displacement = no_value;

  [[nodiscard]] bool is(CommandCode kind) const noexcept { return code == static_cast<std::uint16_t>(kind); }
  /// Nothing keeps a stop or a vent waiting.
  [[nodiscard]] bool halts() const noexcept { return is(CommandCode::stop) || is(CommandCode::vent); }
  friend auto operator<=>(const Command&, const Command&) = default;
};

/// How far one connection has followed the counters.
struct Cursor {
  /// The counter that was the newest one when this connection wrote it. Nothing: it has written none.
  std::optional<std::uint16_t> at;
  /// The connection's last counter was refused.
  bool refused = false;

  friend auto operator<=>(const Cursor&, const Cursor&) = default;
};

/// Executes a command only if its counter follows the newest one (65535 is followed by 0), and only for a
/// connection that has written the newest one before. So a block that arrives late, from a second connection
/// or from a master that missed what another one commanded, is refused. The newest counter is the last one
/// that was executed, that is under way or that waits. To write it again changes nothing.
///
/// The first counter after the gateway's start is only stored: the gateway before this one may have executed
/// it.
class Handshake {
 public:
  struct Entry {
    std::uint16_t counter = 0;
    Command command;
    Reason refusal = Reason::none;  ///< it is refused with this when its turn comes

    friend auto operator<=>(const Entry&, const Entry&) = default;
  };

  /// A connection has written a counter. True: the command is to be executed now.
  [[nodiscard]] bool write(Cursor& cursor, const Entry& entry) noexcept;
  /// The command that waited and is to be executed now.
  [[nodiscard]] std::optional<Entry> take_waiting() noexcept;
  /// Refuses the waiting command when its turn comes: a stop that has no counter came after it.
  void refuse_waiting(Reason reason) noexcept;
  /// A command came to an end. One that a later command has overtaken is not reported.
  void finish(std::uint16_t counter, Outcome outcome, Reason reason = Reason::none) noexcept;
  /// The daemon does not answer: what is under way has an unknown end.
  void lose() noexcept;

  /// How far a counter is ahead of the newest one, from -32768 to 32767; 0 before the first one.
  [[nodiscard]] int ahead(std::uint16_t counter) const noexcept;
  /// The last counter that came to an end.
  [[nodiscard]] std::uint16_t done_counter() const noexcept { return done_ ? done_->counter : 0; }
  [[nodiscard]] Outcome outcome() const noexcept { return executing_ ? Outcome::executing : outcome_; }
  [[nodiscard]] Reason reason() const noexcept { return reason_; }
  [[nodiscard]] bool waits() const noexcept { return waiting_.has_value(); }
  /// The last one that came to an end, the one under way, and the one that waits.
  [[nodiscard]] const std::optional<Entry>& done() const noexcept { return done_; }
  [[nodiscard]] const std::optional<Entry>& executing() const noexcept { return executing_; }
  [[nodiscard]] const std::optional<Entry>& waiting() const noexcept { return waiting_; }

 private:
  [[nodiscard]] const Entry& newest() const noexcept;
  [[nodiscard]] const Entry* find(std::uint16_t counter) const noexcept;
  void store_first(Cursor& cursor, const Entry& entry) noexcept;

  std::optional<Entry> done_;
  std::optional<Entry> executing_;
  std::optional<Entry> waiting_;
  Outcome outcome_ = Outcome::none;
  Reason reason_ = Reason::none;
};

}  // namespace softgrip::plc
