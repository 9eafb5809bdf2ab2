#include "daemon/loop/bus.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>

namespace softgrip::daemon {

using control::FaultCode;
using drivers::BusStatus;

namespace {

/// Returns true if the board has responded to the request. A rejection of the request is also a response.
bool is_answer(BusStatus status) noexcept {
  return status != BusStatus::disconnected && status != BusStatus::closed_at_once &&
         status != BusStatus::timed_out && status != BusStatus::bad_reply;
}

/// Returns true if the connection must be closed: the board may still send the response to an old request, or
/// its watchdog has tripped and requires a new connection.
bool loses_session(BusStatus status) noexcept {
  return !is_answer(status) || status == BusStatus::watchdog_tripped;
}

}  // namespace

FaultCode fault_of(BusStatus status) noexcept {
  switch (status) {
    case BusStatus::ok:
      return FaultCode::none;
    case BusStatus::disconnected:
    case BusStatus::closed_at_once:
      return FaultCode::bus_down;
    case BusStatus::timed_out:
      return FaultCode::bus_timed_out;
    case BusStatus::bad_reply:
      return FaultCode::bus_bad_reply;
    case BusStatus::exception:
      return FaultCode::bus_exception;
    case BusStatus::write_refused:
      return FaultCode::write_refused;
    case BusStatus::overwritten:
      return FaultCode::outputs_overwritten;
    case BusStatus::watchdog_tripped:
      return FaultCode::board_watchdog_tripped;
  }
  return FaultCode::bus_down;
}

Bus::Bus(drivers::Board& board, const control::RigSettings& rig, const rig::LoopSettings& loop,
         const rig::ReconnectSettings& reconnect, const Clock& clock, SharedState& shared,
         BusStatistics& statistics) noexcept
    : board_(board),
      loop_(loop),
      reconnect_(reconnect),
      clock_(clock),
      shared_(shared),
      statistics_(statistics),
      channels_(std::min(board.channels(), control::max_channels)),
      watchdog_(board.watchdog_time().count()),
      watchdog_margin_(rig::watchdog_margin(loop, board.watchdog_time()).count()),
      pause_(reconnect.first_pause.count()) {
  for (std::size_t i = 0; i < std::min(channels_, rig.channels.size()); ++i) {
    rest_kpa_[i] = control::resting_kpa(rig.channels[i].limits);
  }
}

void Bus::run(PeriodicSchedule schedule, std::chrono::nanoseconds shutdown_deadline) noexcept {
  Nanoseconds give_up = 0;
  while (!shared_.safe_state_confirmed.load(std::memory_order_relaxed)) {
    clock_.sleep_until(schedule.due());
    step(schedule.due());
    const Nanoseconds now = clock_.now();
    statistics_.overruns.add(schedule.advance(now));
    if (!shared_.shutdown_requested.load(std::memory_order_relaxed)) continue;
    if (give_up == 0) give_up = now + shutdown_deadline.count();
    if (now >= give_up) return;
  }
}

void Bus::step(Nanoseconds due) noexcept {
  statistics_.steps.add();
  statistics_.wake_up.add(clock_.now() - due);
  if (!listen()) return;
  const bool connected = session_ != Session::none;
  if (ensure_session()) {
    // Opening a connection takes time, and the loop may have sent newer commands in this time. The bus uses
    // the newest commands.
    if (!connected && shared_.commands.fetch()) unheard_ = 0;
    exchange();
  } else {
    ++report_.health.consecutive_failures;
  }
  publish();
}

/// Fetches the newest commands of the loop and detects a time-out of the commands. Returns false before the
/// loop has sent its first commands.
bool Bus::listen() noexcept {
  if (shared_.commands.fetch()) {
    spoken_ = true;
    unheard_ = 0;
    obey_if_heard();
  } else if (spoken_ && !shared_.commands.value().last && ++unheard_ == loop_.max_missed_commands) {
    inhibit(FaultCode::cycles_lost);
    tell(BusEvent::Kind::loop_silent, BusStatus::ok);
  }
  return spoken_;
}

void Bus::inhibit(FaultCode reason) noexcept {
  inhibited_ = reason;
  ++report_.health.inhibit;
}

void Bus::obey_if_heard() noexcept {
  const Commands& commands = shared_.commands.value();
  if (inhibited_ == FaultCode::none || commands.inhibit != report_.health.inhibit || commands.may_rise)
    return;
  for (std::size_t i = 0; i < channels_; ++i) {
    const double command_kpa = commands.command_kpa[i];
    if (control::no_further(rest_kpa_[i], command_kpa, report_.outputs_kpa[i]) != command_kpa) return;
  }
  if (inhibited_ == FaultCode::cycles_lost) tell(BusEvent::Kind::loop_back, BusStatus::ok);
  inhibited_ = FaultCode::none;
}

bool Bus::ensure_session() noexcept {
  if (session_ != Session::none) return true;
  if (clock_.now() < next_attempt_) return false;
  report_.health.connected = false;
  publish();  // connect() may take long, so the new state of the bus is published to the loop before the call
  statistics_.attempts.fetch_add(1, std::memory_order_relaxed);
  const BusStatus status = board_.connect(reconnect_.connect_deadline);
  if (status == BusStatus::ok) {
    session_ = Session::opened;
    statistics_.sessions.add();
    told_clients_ = false;
    return true;
  }
  put_off_next_attempt();
  const bool another = told_failed_;
  note_failure(status);
  if (another) note_refusal(status);
  return false;
}

void Bus::put_off_next_attempt() noexcept {
  next_attempt_ = clock_.now() + pause_;
  statistics_.retry_pause.store(pause_, std::memory_order_relaxed);
  pause_ = std::min<Nanoseconds>(2 * pause_, reconnect_.longest_pause.count());
}

void Bus::exchange() noexcept {
  const Nanoseconds began = clock_.now();
  judge_gap(began, watchdog_margin_);
  choose_outputs();
  const bool last = shared_.commands.value().last;
  const BusStatus status =
      board_.exchange(std::span(written_kpa_).first(channels_), std::span(report_.readings).first(channels_),
                      std::chrono::nanoseconds(nanoseconds(loop_.exchange_deadline_s)));
  const Nanoseconds ended = clock_.now();
  statistics_.exchanges.add();
  if (session_ == Session::opened && is_answer(status)) {
    session_ = Session::answered;
    tell(BusEvent::Kind::connected, BusStatus::ok);
  }
  if (status != BusStatus::ok) {
    // A board may open a session although a part of it is missing. Only the first exchange then fails.
    const bool incomplete = session_ == Session::opened && status == BusStatus::disconnected;
    if (loses_session(status)) {
      // If every new connection fails at its first exchange, the daemon must not reconnect in every cycle.
      if (session_ != Session::proven) put_off_next_attempt();
      session_ = Session::none;
    }
    ++report_.health.consecutive_failures;
    const bool another = told_failed_;
    // If this thread was stopped during the exchange, the deadline of the exchange has passed, although the
    // board and the line may be in order. The gap is then the useful message.
    judge_gap(ended, 0);
    note_failure(status);
    if (another && (incomplete || status == BusStatus::closed_at_once)) note_refusal(status);
    return;
  }
  report_.outputs_kpa = written_kpa_;
  // If this thread was stopped during the exchange, the commands may have reached the board after the board's
  // watchdog time. The board had then set its safe outputs before it received the commands.
  judge_gap(ended, 0);
  last_good_ = began;
  note_success(ended - began);
  if (last) shared_.safe_state_confirmed.store(true, std::memory_order_release);
}

void Bus::choose_outputs() noexcept {
  respect_found_outputs();
  const Commands& commands = shared_.commands.value();
  written_kpa_ = silent() ? commands.safe_kpa : commands.command_kpa;
  if (commands.may_rise && inhibited_ == FaultCode::none) return;
  for (std::size_t i = 0; i < channels_; ++i) {
    written_kpa_[i] = control::no_further(rest_kpa_[i], written_kpa_[i], report_.outputs_kpa[i]);
  }
}

void Bus::note_success(Nanoseconds duration) noexcept {
  found_kpa_ = BusReport::anything;
  session_ = Session::proven;
  statistics_.attempts.store(0, std::memory_order_relaxed);
  pause_ = reconnect_.first_pause.count();
  statistics_.exchange.add(duration);
  report_.health.connected = true;
  report_.health.fault = inhibited_;
  report_.health.consecutive_failures = silent() ? unheard_ : 0;
  if (told_failed_) tell(BusEvent::Kind::recovered, BusStatus::ok);
  told_failed_ = false;
  told_refused_ = false;
  note_clients();
}

/// Reports another client of the board once per connection, so that a client that reconnects often does not
/// fill the log. The report is needed only for a client that feeds the board's watchdog by reading. A client
/// that writes is detected by the change of the outputs.
void Bus::note_clients() noexcept {
  if (told_clients_ || !board_.fed_by_readers()) return;
  const unsigned clients = board_.clients();
  if (clients < 2) return;
  told_clients_ = true;
  std::array<char, 12> count{};
  std::snprintf(count.data(), count.size(), "%u", clients);
  tell(BusEvent::Kind::another_client, BusStatus::ok, count.data());
}

void Bus::note_failure(BusStatus status) noexcept {
  // After a failed exchange, the bus does not know if the board has applied the written values.
  for (std::size_t i = 0; i < channels_; ++i) {
    report_.outputs_kpa[i] = control::no_further(rest_kpa_[i], written_kpa_[i], report_.outputs_kpa[i]);
  }
  if (status == BusStatus::write_refused) {
    for (std::size_t i = 0; i < channels_; ++i) {
      const double found_kpa = board_.found_kpa(i);
      found_kpa_[i] = std::isfinite(found_kpa) ? found_kpa : BusReport::anything[i];
    }
    respect_found_outputs();
  }
  const bool others = status == BusStatus::overwritten;
  if (others || status == BusStatus::watchdog_tripped) rest_outputs();
  // A tripped watchdog of the board also changes the outputs. A change of the outputs after a trip therefore
  // does not prove that there is another client.
  const bool known = others && inhibited_ == FaultCode::board_watchdog_tripped;
  if (control::inhibits(fault_of(status)) && !known) inhibit(fault_of(status));
  statistics_.failures.add();
  report_.health.connected = session_ != Session::none;
  report_.health.fault = inhibited_ == FaultCode::none ? fault_of(status) : inhibited_;
  if (told_failed_) return;
  told_failed_ = true;
  tell(BusEvent::Kind::failed, status, board_.detail());
}

/// Uses the outputs that the board reports as the present outputs if they are nearer to rest than the written
/// commands. Writing the last commands a second time would move these outputs away from rest. Outputs whose
/// safe action is hold are not used in this way, because a gateway that repeats an old reading must not open
/// a grip. For such a channel, the written commands count as the present outputs until commands with another
/// safe action arrive.
void Bus::respect_found_outputs() noexcept {
  const Commands& commands = shared_.commands.value();
  for (std::size_t i = 0; i < channels_; ++i) {
    const bool holds = commands.safe_kpa[i] != rest_kpa_[i];
    if (holds) continue;
    report_.outputs_kpa[i] = control::no_further(rest_kpa_[i], report_.outputs_kpa[i], found_kpa_[i]);
  }
}

/// Reports once per outage why no new connection can be opened. Does not report if this reason equals the
/// reason for the loss of the last connection. Example of a new reason: a converter was removed, and another
/// converter now has its name.
void Bus::note_refusal(BusStatus status) noexcept {
  if (told_refused_ || std::strncmp(told_.data(), board_.detail(), told_.size() - 1) == 0) return;
  told_refused_ = true;
  tell(BusEvent::Kind::not_connected, status, board_.detail());
}

/// Assumes that the board has set its safe outputs if it was not fed for longer than its watchdog time.
void Bus::judge_gap(Nanoseconds now, Nanoseconds margin) noexcept {
  if (watchdog_ == 0 || !last_good_ || now - *last_good_ < watchdog_ - margin) return;
  rest_outputs();
  inhibit(FaultCode::board_watchdog_tripped);
  std::array<char, sizeof(BusEvent::detail)> detail{};
  std::snprintf(detail.data(), detail.size(),
                "no successful exchange with the board for %.3f s; the board's own watchdog vents the "
                "outputs after %.3f s",
                seconds(now - *last_good_), seconds(watchdog_));
  tell(BusEvent::Kind::failed, BusStatus::watchdog_tripped, detail.data());
  told_failed_ = true;
  last_good_.reset();  // so that each gap is handled once
}

void Bus::rest_outputs() noexcept {
  std::copy_n(rest_kpa_.begin(), channels_, report_.outputs_kpa.begin());
}

void Bus::tell(BusEvent::Kind kind, BusStatus status, const char* detail) noexcept {
  BusEvent event;
  event.kind = kind;
  event.at = clock_.now();
  event.status = status;
  std::snprintf(event.detail.data(), event.detail.size(), "%s", detail);
  if (kind == BusEvent::Kind::failed) told_ = event.detail;
  shared_.bus_events.push(event);
}

void Bus::publish() noexcept {
  shared_.bus.publish(report_);
}

}  // namespace softgrip::daemon
