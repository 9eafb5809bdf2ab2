#include "daemon/loop/bus.h"

#include <algorithm>
#include <cstdio>
#include <span>

namespace softgrip::daemon {

using control::FaultCode;
using drivers::BusStatus;

namespace {

/// After these the board may still send what belongs to an old question, or waits for the greeting that only
/// a new session brings: the session is not used again.
bool loses_session(BusStatus status) noexcept {
  return status == BusStatus::disconnected || status == BusStatus::timed_out ||
         status == BusStatus::bad_reply || status == BusStatus::watchdog_tripped;
}

/// After these the outputs are not where the controller believes they are.
bool said_by_board(BusStatus status) noexcept {
  return status == BusStatus::write_refused || status == BusStatus::watchdog_tripped;
}

/// The loop reads the newest report only; with several it cannot miss what the board said, however their
/// grids jitter against each other.
constexpr std::uint32_t reports_of_a_refusal = 3;

}  // namespace

FaultCode fault_of(BusStatus status) noexcept {
  switch (status) {
    case BusStatus::ok:
      return FaultCode::none;
    case BusStatus::disconnected:
      return FaultCode::bus_down;
    case BusStatus::timed_out:
      return FaultCode::bus_timed_out;
    case BusStatus::bad_reply:
      return FaultCode::bus_bad_reply;
    case BusStatus::exception:
      return FaultCode::bus_exception;
    case BusStatus::write_refused:
      return FaultCode::write_refused;
    case BusStatus::watchdog_tripped:
      return FaultCode::board_watchdog_tripped;
  }
  return FaultCode::bus_down;
}

Bus::Bus(drivers::Board& board, const rig::LoopSettings& loop, const rig::ReconnectSettings& reconnect,
         const Clock& clock, Wires& wires, BusStatistics& statistics) noexcept
    : board_(board),
      loop_(loop),
      reconnect_(reconnect),
      clock_(clock),
      wires_(wires),
      statistics_(statistics),
      channels_(std::min(board.channels(), control::max_channels)),
      pause_(reconnect.first_pause.count()) {}

void Bus::run(Grid grid, std::chrono::nanoseconds leave_deadline) noexcept {
  Nanoseconds give_up = 0;
  while (!wires_.left_safely.load(std::memory_order_relaxed)) {
    clock_.sleep_until(grid.due());
    step(grid.due());
    const Nanoseconds now = clock_.now();
    statistics_.slips.add(grid.advance(now));
    if (!wires_.leave.load(std::memory_order_relaxed)) continue;
    if (give_up == 0) give_up = now + leave_deadline.count();
    if (now >= give_up) return;
  }
}

void Bus::step(Nanoseconds due) noexcept {
  statistics_.steps.add();
  statistics_.wake_up.add(clock_.now() - due);
  if (!fetch_commands()) return;
  if (ensure_session()) {
    exchange();
  } else {
    ++report_.health.consecutive_failures;
  }
  publish();
}

bool Bus::fetch_commands() noexcept {
  const bool fetched = wires_.commands.fetch();
  const Commands& commands = wires_.commands.value();
  if (fetched) unheard_ = 0;
  switch (hearing_) {
    case Hearing::nothing_yet:
      if (fetched) hearing_ = Hearing::commands;
      break;
    case Hearing::commands:
      if (fetched || commands.last || ++unheard_ != loop_.max_missed_commands) break;
      hearing_ = Hearing::silence;
      tell(BusEvent::Kind::loop_silent, BusStatus::ok);
      break;
    case Hearing::silence:
      if (!fetched) ++unheard_;
      // What the safe outputs did in the meantime the loop did not know; its motion must end first.
      if (!fetched || commands.moving) break;
      hearing_ = Hearing::commands;
      tell(BusEvent::Kind::loop_back, BusStatus::ok);
      break;
  }
  return hearing_ != Hearing::nothing_yet;
}

bool Bus::ensure_session() noexcept {
  if (session_ != Session::none) return true;
  if (clock_.now() < next_attempt_) return false;
  report_.health.connected = false;
  publish();  // connect() may take its time; the loop shall know meanwhile
  const BusStatus status = board_.connect(reconnect_.connect_deadline);
  if (status == BusStatus::ok) {
    session_ = Session::opened;
    statistics_.sessions.add();
    tell(BusEvent::Kind::connected, status);
    return true;
  }
  put_off_next_attempt();
  note_failure(status);
  return false;
}

void Bus::put_off_next_attempt() noexcept {
  next_attempt_ = clock_.now() + pause_;
  pause_ = std::min<Nanoseconds>(2 * pause_, reconnect_.longest_pause.count());
}

void Bus::exchange() noexcept {
  const Commands& commands = wires_.commands.value();
  const bool silent = hearing_ == Hearing::silence;
  const auto& outputs = silent ? commands.safe_kpa : commands.command_kpa;
  const Nanoseconds begin = clock_.now();
  const BusStatus status =
      board_.exchange(std::span(outputs).first(channels_), std::span(report_.readings).first(channels_),
                      std::chrono::nanoseconds(nanoseconds(loop_.exchange_deadline_s)));
  statistics_.exchanges.add();
  if (status != BusStatus::ok) {
    if (loses_session(status)) {
      // A board whose every session fails at its first exchange must not be connected to in every cycle.
      if (session_ == Session::opened) put_off_next_attempt();
      session_ = Session::none;
    }
    ++report_.health.consecutive_failures;
    note_failure(status);
    return;
  }
  session_ = Session::proven;
  pause_ = reconnect_.first_pause.count();
  statistics_.exchange.add(clock_.now() - begin);
  report_.health = {true, silent ? FaultCode::cycles_lost : FaultCode::none, silent ? unheard_ : 0};
  if (repeats_ > 0) {
    --repeats_;
    report_.health.fault = said_;
  }
  if (told_failed_) tell(BusEvent::Kind::recovered, status);
  told_failed_ = false;
  if (commands.last) wires_.left_safely.store(true, std::memory_order_release);
}

void Bus::note_failure(BusStatus status) noexcept {
  if (said_by_board(status)) {
    said_ = fault_of(status);
    repeats_ = reports_of_a_refusal;
  }
  statistics_.failures.add();
  report_.health.connected = session_ != Session::none;
  report_.health.fault = fault_of(status);
  if (told_failed_) return;
  told_failed_ = true;
  tell(BusEvent::Kind::failed, status, board_.detail());
}

void Bus::tell(BusEvent::Kind kind, BusStatus status, const char* detail) noexcept {
  BusEvent event;
  event.kind = kind;
  event.at = clock_.now();
  event.status = status;
  std::snprintf(event.detail.data(), event.detail.size(), "%s", detail);
  wires_.bus_events.push(event);
}

void Bus::publish() noexcept {
  wires_.bus.publish(report_);
}

}  // namespace softgrip::daemon
