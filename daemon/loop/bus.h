#pragma once
// The bus thread. It exchanges data with the board at the rate of the loop, and reopens a lost connection.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/clock.h"
#include "base/periodic_schedule.h"
#include "control/elements/fault.h"
#include "control/tick/settings.h"
#include "daemon/loop/shared_state.h"
#include "daemon/loop/statistics.h"
#include "drivers/board/board.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// Returns the fault that the supervisor gets for a failed exchange; `none` for a successful exchange.
[[nodiscard]] control::FaultCode fault_of(drivers::BusStatus status) noexcept;

/// The only class that communicates with the board. It writes nothing before the loop has sent its first
/// commands, which are safe outputs.
///
/// Outputs move away from rest only while a sequence runs. If the outputs no longer follow the loop's
/// commands, the bus is inhibited. It then writes no pressure that is further from rest than the present
/// outputs, and reports the reason. The bus follows commands again if all three conditions are met. The
/// commands come from a tick that has read the new value of BusHealth::inhibit. No sequence runs in that
/// tick. The commands are no further from rest than the outputs. The bus is inhibited if
/// - the commands of the loop time out: the safe outputs of the last commands are written (cycles_lost);
/// - the last successful exchange is older than the watchdog time of the board, or the board reports that its
///   watchdog has tripped: the rest pressures are written (board_watchdog_tripped);
/// - the board rejects a write (write_refused). If the board then reports outputs that are nearer to rest,
///   these outputs count as the present outputs, because another client may have written between two requests
///   of the exchange. This rule does not apply to outputs whose safe action is hold, because a gateway may
///   repeat an old reading;
/// - another Modbus client writes to the board: the rest pressures are written (outputs_overwritten).
class Bus {
 public:
  /// All referenced objects must exist longer than this object. `rig` has a channel for each channel of the
  /// board.
  Bus(drivers::Board& board, const control::RigSettings& rig, const rig::LoopSettings& loop,
      const rig::ReconnectSettings& reconnect, const Clock& clock, SharedState& shared,
      BusStatistics& statistics) noexcept;

  /// Tries to open the connection before the first step, so that the start-up report can contain the measured
  /// times of the connection. Blocks up to connect_deadline.
  bool open() noexcept { return ensure_session(); }

  /// Runs on the schedule until the board has confirmed the last commands. Ends without confirmation when
  /// `shutdown_deadline` has passed since the shutdown request to the loop.
  void run(PeriodicSchedule schedule, std::chrono::nanoseconds shutdown_deadline) noexcept;

  /// Performs one exchange, or an attempt to reopen the connection if one is due. `due` is the scheduled
  /// start.
  void step(Nanoseconds due) noexcept;

 private:
  bool listen() noexcept;
  void inhibit(control::FaultCode reason) noexcept;
  void obey_if_heard() noexcept;
  bool ensure_session() noexcept;
  void put_off_next_attempt() noexcept;
  void exchange() noexcept;
  void choose_outputs() noexcept;
  void note_success(Nanoseconds duration) noexcept;
  void note_failure(drivers::BusStatus status) noexcept;
  void respect_found_outputs() noexcept;
  void note_refusal(drivers::BusStatus status) noexcept;
  void note_clients() noexcept;
  void judge_gap(Nanoseconds now, Nanoseconds margin) noexcept;
  void rest_outputs() noexcept;
  void tell(BusEvent::Kind kind, drivers::BusStatus status, const char* detail = "") noexcept;
  void publish() noexcept;
  [[nodiscard]] bool silent() const noexcept { return unheard_ >= loop_.max_missed_commands; }

  drivers::Board& board_;
  const rig::LoopSettings& loop_;
  const rig::ReconnectSettings& reconnect_;
  const Clock& clock_;
  SharedState& shared_;
  BusStatistics& statistics_;
  std::size_t channels_;
  std::array<double, control::max_channels> rest_kpa_{};
  Nanoseconds watchdog_;         // watchdog time of the board [ns]; 0: the board has no watchdog
  Nanoseconds watchdog_margin_;  // longest time from the start of an exchange until its request reaches the
                                 // board [ns]

  /// State of the connection to the board.
  enum class Session : std::uint8_t {
    none,      // the connection is closed; it is opened when the next attempt is due
    opened,    // connect() succeeded, but no exchange has been tried yet
    answered,  // the board has responded to an exchange, but no exchange has been successful yet
    proven,    // an exchange with the board has been successful
  };

  BusReport report_;
  std::array<double, control::max_channels> written_kpa_ = BusReport::anything;
  std::array<double, control::max_channels> found_kpa_ = BusReport::anything;  // outputs [kPa] that the board
                                                                               // has reported after it
                                                                               // rejected a write; reset by
                                                                               // the next successful exchange
  Session session_ = Session::none;
  bool spoken_ = false;                                      // true: the loop has sent commands at least once
  control::FaultCode inhibited_ = control::FaultCode::none;  // reason why the bus is inhibited; `none` if the
                                                             // bus is not inhibited
  std::uint32_t unheard_ = 0;             // number of bus steps since the loop last sent commands
  std::optional<Nanoseconds> last_good_;  // start time of the last successful exchange
  bool told_failed_ = false;              // true: the present failure of the bus has been logged
  bool told_refused_ = false;             // true: the reason why no connection can be
                                          // opened has been logged
  std::array<char, sizeof(BusEvent::detail)> told_{};  // text of the last bus failure that was logged
  bool told_clients_ = false;  // true: another client of the board has been logged since the connection was
                               // opened
  Nanoseconds pause_ = 0;      // pause between the next two attempts to connect [ns]
  Nanoseconds next_attempt_ = 0;
};

}  // namespace softgrip::daemon
