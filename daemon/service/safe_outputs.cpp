#include "daemon/service/safe_outputs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "base/periodic_schedule.h"
#include "daemon/service/board_lock.h"
#include "daemon/service/daemon.h"
#include "daemon/service/trusted_user.h"

namespace softgrip::daemon {

using drivers::BusStatus;

namespace {

/// Longest time of the attempt to write the safe outputs. It must be shorter than TimeoutStopSec= of the
/// systemd unit.
constexpr std::chrono::nanoseconds unit_patience = std::chrono::seconds(8);
/// Longest pause between two attempts. The pause in the rig file can be longer than the complete attempt.
constexpr std::chrono::nanoseconds longest_pause = std::chrono::milliseconds(500);
constexpr int exchanges_that_confirm = 2;

}  // namespace

ExitCode exit_code_of(SafeOutputsEnd end) noexcept {
  switch (end) {
    case SafeOutputsEnd::confirmed:
    case SafeOutputsEnd::board_holds:
    case SafeOutputsEnd::not_needed:
      return ExitCode::done;
    case SafeOutputsEnd::daemon_running:
      return ExitCode::state_refused;
    case SafeOutputsEnd::board_silent:
      return ExitCode::io;
  }
  return ExitCode::io;
}

SafeOutputsReport write_safe_outputs(const rig::RigFile& rig, drivers::Board& board, const Clock& clock,
                                     std::chrono::nanoseconds patience) {
  const std::size_t channels = std::min(board.channels(), rig.settings.channels.size());
  std::array<double, control::max_channels> rest_kpa{};
  for (std::size_t i = 0; i < channels; ++i) {
    rest_kpa[i] = control::resting_kpa(rig.settings.channels[i].limits);
  }
  std::array<model::Reading, control::max_channels> readings{};
  const std::chrono::nanoseconds deadline(nanoseconds(rig.loop.exchange_deadline_s));
  const Nanoseconds give_up = clock.now() + patience.count();
  bool session = false;
  int confirmed = 0;
  std::string failure;
  do {
    BusStatus status = BusStatus::ok;
    if (!session) {
      const std::chrono::nanoseconds left(give_up - clock.now());
      status = board.connect(std::min(rig.reconnect.connect_deadline, left));
    }
    session = status == BusStatus::ok;
    if (session) {
      status =
          board.exchange(std::span(rest_kpa).first(channels), std::span(readings).first(channels), deadline);
    }
    if (status == BusStatus::watchdog_tripped) {
      return {SafeOutputsEnd::board_holds,
              fmt::format("{}: the watchdog of the board holds the outputs at their safe values",
                          board.describe())};
    }
    if (status == BusStatus::ok) {
      if (++confirmed == exchanges_that_confirm) {
        return {SafeOutputsEnd::confirmed, fmt::format("{}: vented and confirmed", board.describe())};
      }
      continue;
    }
    confirmed = 0;
    session = session && status == BusStatus::exception;
    failure = fmt::format("{} ({})", drivers::name_of(status), board.detail());
    const std::chrono::nanoseconds pause = std::min(rig.reconnect.first_pause, longest_pause);
    sleep_until(std::min(clock.now() + pause.count(), give_up));
  } while (confirmed > 0 || clock.now() < give_up);
  return {SafeOutputsEnd::board_silent,
          fmt::format("{}: not confirmed: {}. Only the board's own watchdog can vent the fingers now",
                      board.describe(), failure)};
}

bool safe_outputs_needed(const std::string& service_result) noexcept {
  return service_result != "success";
}

SafeOutputsReport vent_rig(const rig::RigFile& rig) {
  if (daemon_answers(rig.socket.path)) {
    return {SafeOutputsEnd::daemon_running,
            fmt::format("a daemon responds on {}; use `softgrip vent`", rig.socket.path)};
  }
  const auto lock = BoardLock::take(rig, LockPurpose::vent);
  if (!lock) return {SafeOutputsEnd::daemon_running, lock.error()};
  const MonotonicClock clock;
  const auto board = make_board(rig, clock);
  SafeOutputsReport report = write_safe_outputs(rig, *board, clock, unit_patience);
  for (const std::string& remark : lock->remarks()) report.text += "; " + remark;
  return report;
}

}  // namespace softgrip::daemon
