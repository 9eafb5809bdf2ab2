#pragma once
// The bus thread: exchanges with the board at the rate of the loop, and reopens a lost session.

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
#include "rig/loop_settings.h"

namespace softgrip::daemon {

/// Returns the fault that the supervisor gets for a failed exchange; none for ok.
[[nodiscard]] control::FaultCode fault_of(drivers::BusStatus status) noexcept;

/// The only class that communicates with the board. It writes nothing before the loop has sent its first
/// commands, which are safe outputs.
///
/// Outputs move away from rest only while a sequence runs. If the outputs no longer follow the loop's
/// commands, the bus is inhibited. It then writes nothing further from rest than the present outputs, and
/// reports the reason. It follows commands again under three conditions. The commands come from a tick that
/// has read the new value of BusHealth::inhibit. No sequence runs in that tick. The commands are no further
/// from rest than the outputs. The bus is inhibited if
/// - the commands of the loop time out: the safe outputs of the last commands are written (cycles_lost);
/// - the last successful exchange is older than the watchdog time of the board, or the board reports that its
/// watchdog has tripped: the rest pressures are written (board_watchdog_tripped);
/// - the board rejected a write (write_refused). If the board then reports outputs that are nearer to rest,
/// these are the present outputs, because another client may have written between two requests of the
/// exchange. This does not apply to outputs whose safe action is hold, because a gateway may also repeat an
/// old reading;
/// - another Modbus client writes to the board: the rest pressures are written (outputs_overwritten).
class Bus {
 public:
  /// All references must outlive the bus. `rig` has a channel for each channel of the board.
  Bus(drivers::Board& board, const control::RigSettings& rig, const rig::LoopSettings& loop,
      const rig::ReconnectSettings& reconnect, const Clock& clock, SharedState& shared,
      BusStatistics& statistics) noexcept;

  /// Tries to open the session before the first step, so that the measurements of the connection are known.
  /// Blocks up to connect_deadline.
  bool open() noexcept { return ensure_session(); }

  /// Runs on the schedule until the last commands are confirmed, or until `shutdown_deadline` has passed
  /// since the shutdown request to the loop.
  void run(PeriodicSchedule schedule, std::chrono::nanoseconds shutdown_deadline) noexcept;

  /// Performs one exchange, or one attempt to reopen the session if it is due. `due` is the scheduled start.
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
  Nanoseconds watchdog_;         // watchdog time of the board; 0: none
  Nanoseconds watchdog_margin_;  // longest time from the start of an exchange until the board receives it

  /// State of the session with the board.
  enum class Session : std::uint8_t {
    none,      // closed; it is opened when the next attempt is due
    opened,    // connect() succeeded
    answered,  // the board has responded to an exchange
    proven,    // an exchange was successful
  };

  BusReport report_;
  std::array<double, control::max_channels> written_kpa_ = BusReport::anything;
  std::array<double, control::max_channels> found_kpa_ = BusReport::anything;  // outputs reported with a
                                                                               // rejected write, since the
                                                                               // last successful exchange
  Session session_ = Session::none;
  bool spoken_ = false;                                      // the loop has sent commands at least once
  control::FaultCode inhibited_ = control::FaultCode::none;  // reason why the bus is inhibited, or none
  std::uint32_t unheard_ = 0;                                // steps since the loop's last commands
  std::optional<Nanoseconds> last_good_;                     // start of the last successful exchange
  bool told_failed_ = false;                                 // the present failure has been logged
  bool told_refused_ = false;                                // the reason why no session can be opened has
                                                             // been logged
  std::array<char, sizeof(BusEvent::detail)> told_{};        // the last failure in the log
  bool told_clients_ = false;  // the other client of the board has been logged in this session
  Nanoseconds pause_ = 0;      // pause before the attempt after the next one
  Nanoseconds next_attempt_ = 0;
};

}  // namespace softgrip::daemon
