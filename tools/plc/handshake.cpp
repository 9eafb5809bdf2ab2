#include "tools/plc/handshake.h"

namespace softgrip::plc {

bool Handshake::write(Cursor& cursor, const Entry& entry) noexcept {
  cursor.refused = false;
  if (!done_) {
    store_first(cursor, entry);
    return false;
  }
  if (const Entry* const known = find(entry.counter)) {
    // The connection that wrote this counter may already write its next command into the registers, so a
    // repeated counter from the same connection is ignored. A different command with this counter from
    // another connection means that two clients use the same counter.
    const bool repeats =
        entry.command == known->command || entry.command.is(CommandCode::none) || cursor.at == entry.counter;
    cursor.refused = !repeats;
    if (repeats) cursor.at = entry.counter;
    return false;
  }
  const bool follows = ahead(entry.counter) == 1 && cursor.at == newest().counter;
  const bool is_stop_or_vent = entry.command.is_stop_or_vent();
  if (!follows || (waiting_ && !is_stop_or_vent)) {
    cursor.refused = true;
    return false;
  }
  cursor.at = entry.counter;
  if (executing_ && !is_stop_or_vent) {
    waiting_ = entry;
    return false;
  }
  waiting_.reset();
  executing_ = entry;
  reason_ = Reason::none;
  return true;
}

void Handshake::store_first(Cursor& cursor, const Entry& entry) noexcept {
  done_ = entry;
  cursor.at = entry.counter;
  const bool asks = !entry.command.is(CommandCode::none);
  outcome_ = asks ? Outcome::refused : Outcome::none;
  reason_ = asks ? Reason::first_after_start : Reason::none;
}

int Handshake::ahead(std::uint16_t counter) const noexcept {
  return done_ ? static_cast<std::int16_t>(counter - newest().counter) : 0;
}

const Handshake::Entry& Handshake::newest() const noexcept {
  return waiting_ ? *waiting_ : executing_ ? *executing_ : *done_;
}

const Handshake::Entry* Handshake::find(std::uint16_t counter) const noexcept {
  for (const std::optional<Entry>* const entry : {&done_, &executing_, &waiting_}) {
    if (*entry && (*entry)->counter == counter) return &**entry;
  }
  return nullptr;
}

std::optional<Handshake::Entry> Handshake::take_waiting() noexcept {
  if (executing_ || !waiting_) return std::nullopt;
  executing_ = waiting_;
  waiting_.reset();
  reason_ = Reason::none;
  return executing_;
}

void Handshake::refuse_waiting(Reason reason) noexcept {
  if (waiting_) waiting_->refusal = reason;
}

void Handshake::finish(std::uint16_t counter, Outcome outcome, Reason reason) noexcept {
  if (!executing_ || executing_->counter != counter) return;
  done_ = executing_;
  executing_.reset();
  outcome_ = outcome;
  reason_ = reason;
}

void Handshake::on_daemon_lost() noexcept {
  if (executing_) finish(executing_->counter, Outcome::unknown, Reason::no_daemon);
}

}  // namespace softgrip::plc
