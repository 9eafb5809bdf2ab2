#pragma once
// Evaluates the command counters, which ensure that a command is executed at most once.

#include <cstdint>
#include <optional>

#include "tools/plc/codes.h"

namespace softgrip::plc {

/// A command with its parameters, as the registers contain it.
struct Command {
  std::uint16_t code = 0;  ///< code of the command: a CommandCode, or a number that is not a CommandCode
  std::uint16_t recipe = 0;
  std::uint16_t squeeze = no_value;
  std::uint16_t speed = no_value;
  std::uint16_t displacement = no_value;

  [[nodiscard]] bool is(CommandCode kind) const noexcept { return code == static_cast<std::uint16_t>(kind); }
  /// Returns true for stop and vent, which are executed even if another command is in progress.
  [[nodiscard]] bool is_stop_or_vent() const noexcept {
    return is(CommandCode::stop) || is(CommandCode::vent);
  }
  friend auto operator<=>(const Command&, const Command&) = default;
};

/// The latest command counter that one connection has written.
struct Cursor {
  /// The latest counter of this connection that was the newest counter of all connections at the time of the
  /// write; nullopt: there is none.
  std::optional<std::uint16_t> at;
  /// True if the last counter that this connection wrote was refused.
  bool refused = false;

  friend auto operator<=>(const Cursor&, const Cursor&) = default;
};

/// Decides if a command is executed. Two conditions must be met. The counter of the command is the newest
/// counter plus 1 (65535 is followed by 0), and its connection has written the newest counter before. The
/// newest counter is the counter of the last command that was executed, is in progress or waits. These
/// conditions refuse a late command of another connection, and a command of a client that missed a command of
/// another client. Writing the newest counter once more has no effect.
///
/// The first counter after the start of the gateway is stored, but its command is not executed, because an
/// earlier gateway process may have executed the command.
class Handshake {
 public:
  struct Entry {
    std::uint16_t counter = 0;
    Command command;
    Reason refusal = Reason::none;  ///< reason why the command is refused; none: the command may be executed

    friend auto operator<=>(const Entry&, const Entry&) = default;
  };

  /// Processes a counter that a connection has written. Returns true if the caller must execute the command
  /// of this counter at once.
  [[nodiscard]] bool write(Cursor& cursor, const Entry& entry) noexcept;
  /// Returns the waiting command if the caller must execute it at once; otherwise nullopt.
  [[nodiscard]] std::optional<Entry> take_waiting() noexcept;
  /// Refuses the waiting command with the reason `reason`.
  void refuse_waiting(Reason reason) noexcept;
  /// Ends the command with the counter `counter`, and stores its outcome. Has no effect if this command is
  /// not in progress, for example because a stop has replaced it.
  void finish(std::uint16_t counter, Outcome outcome, Reason reason = Reason::none) noexcept;
  /// Sets the outcome of the command in progress to `unknown`. Must be called when the connection to the
  /// daemon is lost.
  void on_daemon_lost() noexcept;

  /// Returns `counter` minus the newest counter, from -32768 to 32767. Returns 0 before the first counter.
  [[nodiscard]] int ahead(std::uint16_t counter) const noexcept;
  /// Returns the counter of the last command that has ended.
  [[nodiscard]] std::uint16_t done_counter() const noexcept { return done_ ? done_->counter : 0; }
  [[nodiscard]] Outcome outcome() const noexcept { return executing_ ? Outcome::executing : outcome_; }
  [[nodiscard]] Reason reason() const noexcept { return reason_; }
  [[nodiscard]] bool has_waiting() const noexcept { return waiting_.has_value(); }
  /// Return the last command that has ended, the command in progress, and the waiting command.
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
