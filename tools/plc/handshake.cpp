#include "tools/plc/handshake.h"

namespace softgrip::plc {

bool Handshake::write(std::uint16_t counter, CommandCode command) noexcept {
  if (!done_) {
    done_ = counter;
    const bool asks = command != CommandCode::none;
    outcome_ = asks ? Outcome::refused : Outcome::none;
    reason_ = asks ? Reason::first_after_start : Reason::none;
    return false;
  }
  if (counter == executing_.value_or(*done_)) return false;
  // Nothing keeps a stop or a vent waiting; anything else waits for the end of what is under way.
  const bool halts = command == CommandCode::stop || command == CommandCode::vent;
  if (executing_ && !halts) return false;
  if (command == CommandCode::none) {
    done_ = counter;
    outcome_ = Outcome::none;
    reason_ = Reason::none;
    return false;
  }
  executing_ = counter;
  reason_ = Reason::none;
  return true;
}

void Handshake::finish(std::uint16_t counter, Outcome outcome, Reason reason) noexcept {
  if (executing_ != counter) return;
  done_ = counter;
  executing_.reset();
  outcome_ = outcome;
  reason_ = reason;
}

void Handshake::lose() noexcept {
  if (executing_) finish(*executing_, Outcome::unknown, Reason::no_daemon);
}

}  // namespace softgrip::plc
